// Who may enter a server's rooms, and with what key: a text file of one line each.
//   alice  guest  *      <key>      alice, and alice-2, alice-phone …, in every room
//   bob    host   salsa  <key>      may change music and scene of the room salsa
//   anna   listener *    <key>      hears and sees, and is not seen
//   salsa  room   salsa  <key>      all who have this key, under any name without a key of its own
//   carol  guest  *      -      invited <invitation's key> 20261127T0800Z
//                                   has been sent an invitation, and has no key yet
//   dave   guest  *      <key>  used    <invitation's key> 20261127T0800Z
//                                   came with one: it opens nothing any more
//   erin   guest  *      -      revoked <invitation's key> 20261127T0800Z
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
#include "tunnel/seal/preshared_key.h"

namespace dance {

enum class KeyKind : std::uint8_t { kGuest, kHost, kListener, kRoom };
std::string_view key_kind_name(KeyKind kind);
std::optional<KeyKind> find_key_kind(std::string_view name);

// A key that a guest was sent for the first time that she comes. The house that comes with it first
// replaces it by a lasting one; from then on it is kept to tell the next that it was used.
enum class InvitationState : std::uint8_t { kOpen, kUsed, kRevoked };
struct InvitationKey {
  PresharedKey key;
  std::int64_t until_s = 0;
  InvitationState state = InvitationState::kOpen;
  bool operator==(const InvitationKey&) const = default;
};

struct KeyEntry {
  GuestId name;
  KeyKind kind = KeyKind::kGuest;
  GuestId room;  // not set: every room
  PresharedKey key;
  bool is_local = false;  // only for programs on the server's own machine
  bool has_key = true;    // false: nothing but the invitation
  std::optional<InvitationKey> invitation;

  bool is_invited() const {
    return invitation && invitation->state == InvitationState::kOpen && !has_key;
  }
  bool operator==(const KeyEntry&) const = default;
};

// What became of a house's wish to bind an invitation to a key that it made; these numbers are in
// the wire format.
enum class Binding : std::uint8_t {
  kBound,    // the key is the guest's from now on; also when it was already
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
  // Of an invitation it stays known that it was revoked.
  bool remove(std::string_view name);
  // From now on `lasting` is the guest's key.
  Binding bind(std::string_view name, const PresharedKey& lasting, std::int64_t now_s);
  // What bind() would say, without doing so: nullopt where it would bind.
  std::optional<Binding> settled_binding(std::string_view name, const PresharedKey& lasting,
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
