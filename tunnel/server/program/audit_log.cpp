#include "tunnel/server/program/audit_log.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/base/printable.h"

namespace dance {
namespace {

// "192.0.0.0/16", "2001:db8:7::/48"; of 32 bits of an IPv4 address the address alone.
std::string network_text(const Address& address, std::size_t ipv4_bits, std::size_t ipv6_bits) {
  const bool is_ipv4 = address.family() == Address::Family::kIpv4;
  const std::size_t bits = is_ipv4 ? ipv4_bits : ipv6_bits;
  std::array<std::uint8_t, 16> ip = address.ip();
  for (std::size_t i = bits / 8; i < ip.size(); ++i) ip[i] = 0;
  const auto masked = Address::of(std::span(ip).first(is_ipv4 ? 4 : 16), 1);
  std::string text = masked.to_string();
  text = text.substr(0, text.rfind(':'));
  if (text.starts_with('[')) text = text.substr(1, text.size() - 2);
  return is_ipv4 && bits == 32 ? text : text + "/" + std::to_string(bits);
}

std::size_t hash_of(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) (text += part) += '\n';
  return std::hash<std::string>()(text);
}

constexpr std::array<std::pair<const char*, std::string AuditEntry::*>, 8> kTexts{
    {{"key", &AuditEntry::key},
     {"address", &AuditEntry::address},
     {"network", &AuditEntry::network},
     {"wide_network", &AuditEntry::wide_network},
     {"room", &AuditEntry::room},
     {"guests", &AuditEntry::guests},
     {"cause", &AuditEntry::cause},
     {"by", &AuditEntry::by}}};

}  // namespace

std::string audit_line(const AuditEntry& entry) {
  nlohmann::ordered_json object;
  object["what"] = kAuditKindNames[static_cast<std::size_t>(entry.kind)];
  object["first_utc_s"] = entry.first_s;
  object["last_utc_s"] = entry.last_s;
  object["count"] = entry.count;
  for (const auto& [name, member] : kTexts)
    if (!(entry.*member).empty()) object[name] = printable(entry.*member);
  return object.dump();
}

std::optional<AuditEntry> parse_audit_line(std::string_view line) {
  const auto object = nlohmann::json::parse(line, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  const auto find = [&](const char* name) { return object.find(name); };
  AuditEntry entry;
  const auto what = find("what"), first = find("first_utc_s"), last = find("last_utc_s"),
             count = find("count"), none = object.end();
  if (what == none || first == none || last == none || count == none || !what->is_string() ||
      !first->is_number_integer() || !last->is_number_integer() || !count->is_number_unsigned())
    return std::nullopt;
  const auto kind = std::ranges::find(kAuditKindNames, what->get<std::string>());
  if (kind == kAuditKindNames.end()) return std::nullopt;
  entry.kind = static_cast<AuditKind>(kind - kAuditKindNames.begin());
  entry.first_s = first->get<std::int64_t>();
  entry.last_s = last->get<std::int64_t>();
  entry.count = count->get<std::uint64_t>();
  for (const auto& [name, member] : kTexts) {
    const auto text = find(name);
    if (text == none) continue;
    if (!text->is_string()) return std::nullopt;
    entry.*member = printable(text->get<std::string>());
  }
  return entry;
}

void AuditLog::add(const Address& from, const AuditEvent& event, std::int64_t now_s) {
  AuditEntry entry;
  entry.kind = event.kind;
  entry.first_s = entry.last_s = now_s;
  entry.key = printable(event.key.substr(0, kLongestKey));
  if (from.is_set()) {
    entry.address = from.to_string();
    entry.network = network_text(from, 32, 64);
    entry.wide_network = network_text(from, 16, 48);
  }
  entry.room = event.room.view();
  for (const GuestId& guest : event.guests) {
    if (!entry.guests.empty()) entry.guests += ' ';
    entry.guests += guest.view();
  }
  entry.cause = event.cause;
  entry.by = event.by.view();
  keep(std::move(entry));
}

void AuditLog::keep(AuditEntry entry) {
  Kept kept;
  switch (entry.kind) {
    case AuditKind::kJoined:
      kept.identity = hash_of({entry.key, entry.network, entry.room, entry.guests});
      break;
    case AuditKind::kRefused:
      kept.identity = hash_of({entry.network, entry.cause});
      break;
    case AuditKind::kRemoved:
      break;  // each removal is listed
  }
  const bool is_refusal = entry.kind == AuditKind::kRefused;
  // Hosts remove guests: many removals by one host leave those of another host alone.
  const std::string& owner = is_refusal         ? entry.wide_network
                             : entry.by.empty() ? entry.key
                                                : entry.by;
  kept.group = hash_of({owner});
  kept.subgroup = hash_of({is_refusal ? entry.network : entry.wide_network});
  std::vector<Kept>& list = lists_[static_cast<std::size_t>(entry.kind)];
  if (entry.kind != AuditKind::kRemoved) {
    const auto same = std::ranges::find_if(list, [&](const Kept& it) {
      return it.identity == kept.identity &&
             (is_refusal || entry.first_s - it.entry.last_s < kSameJoinWithin_s);
    });
    if (same != list.end()) {
      entry.first_s = same->entry.first_s;
      entry.count += same->entry.count;
      list.erase(same);
    }
  }
  if (list.size() == kMostEntries[static_cast<std::size_t>(entry.kind)]) make_place(list);
  kept.line = std::make_shared<const std::string>(audit_line(entry));
  kept.entry = std::move(entry);
  list.push_back(std::move(kept));
  ++changes_;
}

// The group with most entries loses one: the oldest of its subgroup with most entries. Of groups
// with equally many, the one with the oldest entry.
void AuditLog::make_place(std::vector<Kept>& list) {
  const auto largest = [&](std::size_t Kept::*member, const auto& is_counted) {
    std::unordered_map<std::size_t, std::size_t> counts;
    std::size_t most = 0;
    for (const Kept& it : list)
      if (is_counted(it)) most = std::max(most, ++counts[it.*member]);
    const auto first = std::ranges::find_if(
        list, [&](const Kept& it) { return is_counted(it) && counts[it.*member] == most; });
    return (*first).*member;
  };
  const std::size_t group = largest(&Kept::group, [](const Kept&) { return true; });
  const auto is_of_group = [&](const Kept& it) { return it.group == group; };
  const std::size_t subgroup = largest(&Kept::subgroup, is_of_group);
  list.erase(std::ranges::find_if(
      list, [&](const Kept& it) { return is_of_group(it) && it.subgroup == subgroup; }));
}

AuditLog::Lines AuditLog::lines() const {
  Lines lines;
  for (const auto& list : lists_)
    for (const Kept& kept : list) lines.push_back(kept.line);
  return lines;
}

}  // namespace dance
