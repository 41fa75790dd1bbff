// The key that authenticates a link and its server to each other: both derive it from their
// identity keys, or certificates; and where a program finds it.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside. Both functions read files: not for the pose path.
// Failure:      choose_link_key() says which server there is no key for, and how to get one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/net/address.h"
#include "tunnel/seal/keys/house_keys.h"
#include "tunnel/seal/seal_context.h"
#include "tunnel/wire/wire.h"

namespace dance {

struct LinkKey {
  std::string identity;  // what the link calls itself in handshakes
  PresharedKey key;
  PublicKey server_key;  // not set: any, on this machine
  // Set: used in the key's stead; `server` is the name that the server's certificate must bear.
  std::optional<SealCertificates> certificates;
  std::string server;

  Result<std::unique_ptr<SealContext>> context() const;
  static Result<LinkKey> of(const HouseKey& key, const PrivateKey& house);
};

// Where to look; empty = the places where `dance key` puts keys.
struct LinkKeySource {
  std::string key_file;
  SealCertificates certificates;
};

// For a server as the user names it (HOST or HOST:PORT). On this machine none is needed: its own
// key is used, and made where there is none yet.
Result<LinkKey> choose_link_key(const std::string& server, const wire::RoomName& room,
                                const GuestId& first_guest, const LinkKeySource& source);
// The same; nothing where there is no key, and an error only where one cannot be read. `at`: where
// the server is, not set where that is not known; nothing is looked up.
Result<std::optional<LinkKey>> find_link_key(const std::string& server, const Address& at,
                                             const wire::RoomName& room, const GuestId& first_guest,
                                             const LinkKeySource& source);

}  // namespace dance
