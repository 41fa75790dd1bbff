// The guests of a server's rooms and their public keys: a text file of one line each. It has no
// secrets, but whoever can write it decides who enters.
//   alice  guest  *      <key>      alice, and alice-2, alice-phone …, in every room
//   bob    host   salsa  <key>      may change music and scene of the room salsa
//   anna   listener *    <key>      hears and sees, and is not seen
//   salsa  room   salsa  <key>      all who have the private key, under any name that has no key
//   carol  guest  *      -      invited <invitation's key> 20261127T0800Z
//                                   has been sent an invitation, and has no key yet
//   dave   guest  *      <key>  used    <invitation's key> 20261127T0800Z
//                                   came with one: it opens nothing any more
//   erin   guest  *      -      revoked <invitation's key> 20261127T0800Z
// A line may end with when the key expires, also that of a guest who has only been invited:
//   frank  guest  *      <key>  until 20261231T0000Z
//
// Units/frames: seconds of UTC.
// Ownership:    plain values.
// Threads:      none inside; a ring that is shared is not changed any more.
// Failure:      parse() names line and cure; files that others may read are refused.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "tunnel/seal/keys/identity_key.h"

namespace dance {

enum class KeyKind : std::uint8_t { kGuest, kHost, kListener, kRoom };
std::string_view key_kind_name(KeyKind kind);
std::optional<KeyKind> find_key_kind(std::string_view name);

// An invitation's key, sent to a guest for the first visit. The first house that opens a session
// with it becomes the guest: its own key is kept, and the invitation's as well, to tell others that
// it was used.
enum class InvitationState : std::uint8_t { kOpen, kUsed, kRevoked };
struct InvitationKey {
  PublicKey key;
  std::int64_t until_s = 0;
  InvitationState state = InvitationState::kOpen;
  bool operator==(const InvitationKey&) const = default;
};

struct KeyEntry {
  GuestId name;
  KeyKind kind = KeyKind::kGuest;
  GuestId room;  // not set: every room
  // The public key of the guest's house, or of a grant that she, or all of a room, were given.
  PublicKey key;
  // Set: only for programs of this user on the server's own machine, who share this key.
  std::optional<PresharedKey> local_key;
  bool has_key = true;  // false: nothing but the invitation
  std::optional<InvitationKey> invitation;
  // Expiry: the key opens no room afterwards. Not set: it opens rooms until it is removed.
  std::optional<std::int64_t> until_s{};

  bool has_expired(std::int64_t now_s) const { return until_s && now_s >= *until_s; }
  bool is_local() const { return local_key.has_value(); }
  bool is_invited() const {
    return invitation && invitation->state == InvitationState::kOpen && !has_key;
  }
  bool operator==(const KeyEntry&) const = default;
};

// The result of a house's request to bind an invitation to its identity; these numbers are in the
// wire format.
enum class Binding : std::uint8_t {
  kBound,    // the house's key is the guest's from now on; also when it was already
  kUsed,     // another house has come with the invitation
  kRevoked,  // or it was
  kExpired,  // its time is over
  kUnknown,  // there is none
  kNotKept,  // the server could not write its keys
  kNotHere,  // this server takes no invitations
  kCount
};

// As it stands in the file, without an end of line.
std::string line_of(const KeyEntry& entry);

class KeyRing {
 public:
  static constexpr std::size_t kMost = 10'000;

  // `name` stands in errors.
  static Result<KeyRing> parse(std::string_view text, const std::string& name);
  std::string text() const;

  // One that has a key; its invitation opens no room.
  const KeyEntry* find(std::string_view name) const;
  // One that has an invitation, in whatever state.
  const KeyEntry* find_invitation(std::string_view name) const;
  // Whether somebody has a key of her own for this name: "alice", and so "alice-2".
  bool is_own_name(std::string_view name) const;
  // False where the name has a key or an open invitation already, or the ring is full.
  bool add(const KeyEntry& entry);
  // Takes the place of an invitation that is open; false where the name has a key.
  bool invite(const KeyEntry& entry);
  // A removed invitation stays known as revoked.
  bool remove(std::string_view name);
  // Removes a key that has expired, so that its name can get another.
  void remove_expired(std::string_view name, std::int64_t now_s);
  // Makes `house` the guest's key.
  Binding bind(std::string_view name, const PublicKey& house, std::int64_t now_s);
  // The result of bind() without the change: nullopt where it would bind.
  std::optional<Binding> settled_binding(std::string_view name, const PublicKey& house,
                                         std::int64_t now_s) const;
  // Forgets invitations whose time has been over for a day.
  void forget_invitations(std::int64_t now_s);
  const std::vector<KeyEntry>& entries() const { return entries_; }

 private:
  const KeyEntry* entry_of(std::string_view name) const;
  KeyEntry* entry_of(std::string_view name);

  std::vector<KeyEntry> entries_;  // by name
};

}  // namespace dance
