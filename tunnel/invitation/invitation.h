// An invitation: all that a guest needs to come to a room for the first time, as one line that can
// be sent, clicked or shown as a QR code:
//   dance://dance.example.org/salsa?v=2&guest=alice&server=…&key=…&until=20261127T0800Z&check=…
// Port 7400 is left out, a room too where every room is open; role=host or role=listener where it
// is no guest's. `server` is the server's public key: no other server can open a session with the
// house, not even one that knows the whole line. `key` is a private key of which the server keeps
// the public half; it opens one session, which makes the house's own identity the guest's.
//
// Units/frames: seconds of UTC.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      parse_invitation() says which part of a text is wrong, and never what stands there:
//               it may be the key.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/keys/key_ring.h"

namespace dance {

constexpr std::uint16_t kInvitationPort = 7400;  // where the text names none

struct Invitation {
  std::string host;  // a name, an IPv4 address, or an IPv6 address without brackets; small letters
  std::uint16_t port = kInvitationPort;
  GuestId room;  // not set: every room
  GuestId guest;
  KeyKind role = KeyKind::kGuest;  // not kRoom
  PublicKey server_key;
  PrivateKey key;            // good once
  std::int64_t until_s = 0;  // in whole minutes

  // HOST:PORT.
  std::string server() const;
  // For people and logs, without the key: alice@dance.example.org:7400/salsa.
  std::string title() const;
  // The line that the house keeps once the server knows its identity.
  HouseKey house_key() const;
  bool operator==(const Invitation&) const = default;
};

// Whether a text means to be an invitation; only such a one is worth parse_invitation()'s errors.
bool is_invitation(std::string_view text);

// Takes what text_of() writes, with white space around it, in another order, or with characters
// written as %41; further parameters in small letters are left aside, as programs that pass links
// on add some.
Result<Invitation> parse_invitation(std::string_view text);

// The secret line. Not for logs.
std::string text_of(const Invitation& invitation);

// HOST[:PORT] as a user names a server; an error says what is wrong with it.
Result<void> set_server(Invitation& invitation, std::string_view server);

}  // namespace dance
