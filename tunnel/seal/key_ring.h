// Who may enter a server's rooms, and with what key: a text file of one line each.
//   alice  guest  *      <key>      alice, and alice-2, alice-phone …, in every room
//   bob    host   salsa  <key>      may change music and scene of the room salsa
//   anna   listener *    <key>      hears and sees, and is not seen
//   salsa  room   salsa  <key>      all who have this key, under any name without a key of its own
//
// Units/frames: none.
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

struct KeyEntry {
  GuestId name;
  KeyKind kind = KeyKind::kGuest;
  GuestId room;  // not set: every room
  PresharedKey key;
  bool is_local = false;  // only for programs on the server's own machine
  bool operator==(const KeyEntry&) const = default;
};

// As it stands in the file, without an end of line.
std::string line_of(const KeyEntry& entry);

class KeyRing {
 public:
  static constexpr std::size_t kMost = 10'000;

  // `name` stands in errors.
  static Result<KeyRing> parse(std::string_view text, const std::string& name);
  std::string text() const;

  const KeyEntry* find(std::string_view name) const;
  // Whether somebody has a key of her own for this name: "alice", and so "alice-2".
  bool is_own_name(std::string_view name) const;
  // False where the name is taken already, or the ring is full.
  bool add(const KeyEntry& entry);
  bool remove(std::string_view name);
  const std::vector<KeyEntry>& entries() const { return entries_; }

 private:
  std::vector<KeyEntry> entries_;  // by name
};

}  // namespace dance
