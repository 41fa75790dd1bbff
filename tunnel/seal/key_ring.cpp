#include "tunnel/seal/key_ring.h"

#include <algorithm>
#include <array>

#include "core/base/take_line.h"

namespace dance {
namespace {

constexpr std::array<std::string_view, 4> kKindNames{"guest", "host", "listener", "room"};

// The next word of a line, and the line without it.
std::string_view take_word(std::string_view& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
  line.remove_prefix(word.size());
  return word;
}

// Who swaps columns may have put the key there: what is too long to be a name is not said.
std::string said(std::string_view word) {
  return word.size() <= kMaxGuestIdLength ? "'" + std::string(word) + "'" : "a long word";
}

Result<KeyEntry> parse_entry(std::string_view line, const std::string& where) {
  const std::string_view name = take_word(line), kind = take_word(line), room = take_word(line),
                         key = take_word(line);
  if (key.empty() || !take_word(line).empty())
    return fail(where + ": a line is NAME KIND ROOM KEY; make one with dance server --new-guest");
  KeyEntry entry;
  const auto id = GuestId::parse(name);
  if (!id) return fail(where + ", name: " + said(name) + ": " + kGuestIdRule);
  entry.name = *id;
  const auto known_kind = find_key_kind(kind);
  if (!known_kind)
    return fail(where + ", kind: " + said(kind) + " is none of guest, host, listener, room");
  entry.kind = *known_kind;
  if (room != "*") {
    const auto room_id = GuestId::parse(room);
    if (!room_id)
      return fail(where + ", room: " + said(room) +
                  ": 1 to 24 characters of a-z, 0-9 and '-', or * for every room");
    entry.room = *room_id;
  }
  // Never in the message: it may be a key with one character too many.
  const auto parsed = PresharedKey::parse(key);
  if (!parsed)
    return fail(where +
                ": what stands where the key belongs is none; make a new one with dance "
                "server --new-guest");
  entry.key = *parsed;
  return entry;
}

}  // namespace

std::string_view key_kind_name(KeyKind kind) { return kKindNames[static_cast<std::size_t>(kind)]; }

std::optional<KeyKind> find_key_kind(std::string_view name) {
  const auto found = std::find(kKindNames.begin(), kKindNames.end(), name);
  if (found == kKindNames.end()) return std::nullopt;
  return static_cast<KeyKind>(found - kKindNames.begin());
}

std::string line_of(const KeyEntry& entry) {
  return std::string(entry.name.view()) + " " + std::string(key_kind_name(entry.kind)) + " " +
         (entry.room.is_set() ? std::string(entry.room.view()) : "*") + " " + entry.key.text();
}

Result<KeyRing> KeyRing::parse(std::string_view text, const std::string& name) {
  KeyRing ring;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::string_view line = take_line(text);
    std::string_view rest = line;
    const std::string_view first = take_word(rest);
    if (first.empty() || first.front() == '#') continue;
    const std::string where = name + " line " + std::to_string(number);
    DANCE_TRY(const KeyEntry entry, parse_entry(line, where));
    if (ring.entries_.size() == kMost)
      return fail(where + ": a server takes at most " + std::to_string(kMost) + " keys");
    if (!ring.add(entry))
      return fail(where + ": '" + std::string(first) + "' has a key already; remove one of them");
  }
  return ring;
}

std::string KeyRing::text() const {
  std::string text =
      "# Keys of a dance server: NAME KIND ROOM KEY. Anyone who reads this can enter.\n";
  for (const KeyEntry& entry : entries_) text += line_of(entry) + "\n";
  return text;
}

const KeyEntry* KeyRing::find(std::string_view name) const {
  const auto place = std::lower_bound(
      entries_.begin(), entries_.end(), name,
      [](const KeyEntry& entry, std::string_view wanted) { return entry.name.view() < wanted; });
  return place != entries_.end() && place->name.view() == name ? &*place : nullptr;
}

bool KeyRing::is_own_name(std::string_view name) const {
  for (;;) {
    const KeyEntry* entry = find(name);
    if (entry != nullptr && entry->kind != KeyKind::kRoom) return true;
    const auto dash = name.rfind('-');
    if (dash == std::string_view::npos) return false;
    name = name.substr(0, dash);
  }
}

bool KeyRing::add(const KeyEntry& entry) {
  const auto place =
      std::lower_bound(entries_.begin(), entries_.end(), entry,
                       [](const KeyEntry& a, const KeyEntry& b) { return a.name < b.name; });
  if (place != entries_.end() && place->name == entry.name) return false;
  if (entries_.size() == kMost) return false;
  entries_.insert(place, entry);
  return true;
}

bool KeyRing::remove(std::string_view name) {
  return std::erase_if(entries_, [&](const KeyEntry& e) { return e.name.view() == name; }) > 0;
}

}  // namespace dance
