#include "apps/status/log_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/base/take_line.h"
#include "tunnel/seal/keys/utc_text.h"
#include "tunnel/server/program/audit_log.h"

namespace dance {
namespace {

struct Parsed {
  std::vector<AuditEntry> entries;  // by time
  std::size_t unknown_lines = 0;
};

Parsed parsed(std::string_view lines) {
  Parsed all;
  while (!lines.empty()) {
    const std::string_view line = take_line(lines);
    if (const auto entry = parse_audit_line(line))
      all.entries.push_back(*entry);
    else
      all.unknown_lines += line.empty() ? 0 : 1;
  }
  std::ranges::stable_sort(all.entries, {}, &AuditEntry::last_s);
  return all;
}

std::string or_dash(const std::string& text) { return text.empty() ? "-" : text; }

// "wrong_key, 12 times since 2026-11-27 08:00 UTC"
std::string details_of(const AuditEntry& entry) {
  std::string text = entry.cause;
  if (!entry.by.empty()) text += " " + entry.by;
  if (entry.count == 1) return text;
  return text + fmt::format("{}{} times since {}", text.empty() ? "" : ", ", entry.count,
                            utc_shown(entry.first_s));
}

}  // namespace

std::string log_text(std::string_view lines) {
  const Parsed all = parsed(lines);
  if (all.entries.empty() && all.unknown_lines == 0)
    return "(nobody has joined, been refused or been removed yet)\n";
  constexpr const char* kRow = "{:<21}{:<9}{:<25}{:<24}{:<17}{:<17}{}\n";
  std::string out =
      fmt::format(fmt::runtime(kRow), "last", "what", "key", "from", "room", "guests", "details");
  for (const AuditEntry& entry : all.entries)
    fmt::format_to(std::back_inserter(out), fmt::runtime(kRow), utc_shown(entry.last_s),
                   kAuditKindNames[static_cast<std::size_t>(entry.kind)], or_dash(entry.key),
                   or_dash(entry.address), or_dash(entry.room), or_dash(entry.guests),
                   details_of(entry));
  if (all.unknown_lines > 0)
    fmt::format_to(std::back_inserter(out), "({} lines of another version left out)\n",
                   all.unknown_lines);
  return out;
}

std::string log_json(std::string_view lines) {
  std::string out;
  for (const AuditEntry& entry : parsed(lines).entries) out += audit_line(entry) + "\n";
  return out;
}

}  // namespace dance
