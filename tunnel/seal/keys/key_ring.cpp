#include "tunnel/seal/keys/key_ring.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/take_line.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

constexpr std::array<std::string_view, 4> kKindNames{"guest", "host", "listener", "room"};
constexpr std::array<std::string_view, 3> kInvitationWords{"invited", "used", "revoked"};
constexpr std::int64_t kInvitationsAreKnown_s = 24 * 3600;

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

// Takes "until" and a time off the line, where it begins with them.
Result<std::optional<std::int64_t>> take_expiry(std::string_view& line, const std::string& where) {
  std::string_view rest = line;
  if (take_word(rest) != "until") return std::optional<std::int64_t>();
  const auto until_s = parse_utc(take_word(rest));
  if (!until_s) return fail(where + ", until: write the expiry time like 20261127T0800Z, in UTC");
  line = rest;
  return until_s;
}

// Takes what has become of an invitation, its key, and when it expires.
Result<std::optional<InvitationKey>> take_invitation_words(std::string_view& line,
                                                           const std::string& where) {
  std::string_view rest = line;
  const std::string_view word = take_word(rest);
  if (word.empty() || word == "until") return std::optional<InvitationKey>();
  const std::string_view key = take_word(rest), until = take_word(rest);
  line = rest;
  const auto known = std::find(kInvitationWords.begin(), kInvitationWords.end(), word);
  const auto parsed = PublicKey::parse(key);
  const auto until_s = parse_utc(until);
  if (known == kInvitationWords.end() || !parsed || !until_s)
    return fail(where +
                ": a line is NAME KIND ROOM KEY, and of an invitation, behind it, invited, used or "
                "revoked, its key and until when; make one with dance server --invite");
  return std::optional(InvitationKey{
      *parsed, *until_s, static_cast<InvitationState>(known - kInvitationWords.begin())});
}

Result<KeyEntry> parse_entry(std::string_view line, const std::string& where) {
  const std::string_view name = take_word(line), kind = take_word(line), room = take_word(line),
                         key = take_word(line);
  if (key.empty())
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
  DANCE_TRY(entry.invitation, take_invitation_words(line, where));
  DANCE_TRY(entry.until_s, take_expiry(line, where));
  if (!take_word(line).empty())
    return fail(where +
                ": a line is NAME KIND ROOM KEY, then optionally the state of an invitation and "
                "'until TIME'; make one with dance server --new-guest");
  entry.has_key = key != "-";
  const bool is_used = entry.invitation && entry.invitation->state == InvitationState::kUsed;
  if (entry.invitation ? is_used != entry.has_key : !entry.has_key)
    return fail(where +
                ": - stands for the key of a guest who is invited, or was, and only there; make "
                "another with dance server --invite");
  if (entry.invitation && entry.kind == KeyKind::kRoom)
    return fail(where + ": an invitation is for one guest, and not for a room");
  if (!entry.has_key) return entry;
  // Never in the message: a private key may have been put there.
  const auto parsed = PublicKey::parse(key);
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
         (entry.room.is_set() ? std::string(entry.room.view()) : "*") + " " +
         (entry.has_key ? entry.key.text() : "-") +
         (entry.invitation
              ? " " +
                    std::string(
                        kInvitationWords[static_cast<std::size_t>(entry.invitation->state)]) +
                    " " + entry.invitation->key.text() + " " + utc_text(entry.invitation->until_s)
              : "") +
         (entry.until_s ? " until " + utc_text(*entry.until_s) : "");
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
  std::string text = "# Public keys of the guests of a dance server: NAME KIND ROOM KEY.\n";
  for (const KeyEntry& entry : entries_) text += line_of(entry) + "\n";
  return text;
}

const KeyEntry* KeyRing::entry_of(std::string_view name) const {
  const auto place = std::lower_bound(
      entries_.begin(), entries_.end(), name,
      [](const KeyEntry& entry, std::string_view wanted) { return entry.name.view() < wanted; });
  return place != entries_.end() && place->name.view() == name ? &*place : nullptr;
}

KeyEntry* KeyRing::entry_of(std::string_view name) {
  return const_cast<KeyEntry*>(std::as_const(*this).entry_of(name));
}

const KeyEntry* KeyRing::find(std::string_view name) const {
  const KeyEntry* entry = entry_of(name);
  return entry != nullptr && entry->has_key ? entry : nullptr;
}

const KeyEntry* KeyRing::find_invitation(std::string_view name) const {
  const KeyEntry* entry = entry_of(name);
  return entry != nullptr && entry->invitation ? entry : nullptr;
}

bool KeyRing::is_own_name(std::string_view name) const {
  for (;;) {
    const KeyEntry* entry = entry_of(name);
    if (entry != nullptr && entry->kind != KeyKind::kRoom &&
        (entry->has_key || entry->is_invited()))
      return true;
    const auto dash = name.rfind('-');
    if (dash == std::string_view::npos) return false;
    name = name.substr(0, dash);
  }
}

bool KeyRing::add(const KeyEntry& entry) {
  if (KeyEntry* known = entry_of(entry.name.view())) {
    if (known->has_key || known->is_invited()) return false;
    *known = entry;
    return true;
  }
  if (entries_.size() == kMost) return false;
  const auto place =
      std::lower_bound(entries_.begin(), entries_.end(), entry,
                       [](const KeyEntry& a, const KeyEntry& b) { return a.name < b.name; });
  entries_.insert(place, entry);
  return true;
}

bool KeyRing::invite(const KeyEntry& entry) {
  KeyEntry* known = entry_of(entry.name.view());
  if (known == nullptr) return add(entry);
  if (known->has_key) return false;
  *known = entry;
  return true;
}

bool KeyRing::remove(std::string_view name) {
  KeyEntry* entry = entry_of(name);
  if (entry == nullptr || !(entry->has_key || entry->is_invited())) return false;
  if (!entry->invitation) {
    entries_.erase(entries_.begin() + (entry - entries_.data()));
    return true;
  }
  entry->key = PublicKey();
  entry->has_key = false;
  entry->invitation->state = InvitationState::kRevoked;
  return true;
}

void KeyRing::remove_expired(std::string_view name, std::int64_t now_s) {
  const KeyEntry* entry = find(name);
  if (entry != nullptr && entry->has_expired(now_s)) remove(name);
}

std::optional<Binding> KeyRing::settled_binding(std::string_view name, const PublicKey& house,
                                                std::int64_t now_s) const {
  const KeyEntry* entry = find_invitation(name);
  if (entry == nullptr) return Binding::kUnknown;
  switch (entry->invitation->state) {
    case InvitationState::kRevoked:
      return Binding::kRevoked;
    case InvitationState::kUsed:
      return entry->key == house ? Binding::kBound : Binding::kUsed;
    case InvitationState::kOpen:
      break;
  }
  if (now_s >= entry->invitation->until_s) return Binding::kExpired;
  // Everybody who has read the invitation has its private key.
  if (entry->invitation->key == house) return Binding::kUsed;
  return std::nullopt;
}

Binding KeyRing::bind(std::string_view name, const PublicKey& house, std::int64_t now_s) {
  if (const auto settled = settled_binding(name, house, now_s)) return *settled;
  KeyEntry& entry = *entry_of(name);
  entry.key = house;
  entry.has_key = true;
  entry.invitation->state = InvitationState::kUsed;
  return Binding::kBound;
}

void KeyRing::forget_invitations(std::int64_t now_s) {
  for (KeyEntry& entry : entries_)
    if (entry.invitation && now_s - entry.invitation->until_s > kInvitationsAreKnown_s)
      entry.invitation.reset();
  std::erase_if(entries_, [](const KeyEntry& it) { return !it.has_key && !it.invitation; });
}

}  // namespace dance
