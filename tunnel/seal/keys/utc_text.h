// Until when a key is good, as text: to the minute, in UTC, the same on every machine.
//   in files and links   20261127T0800Z
//   for people           2026-11-27 08:00 UTC
//
// Units/frames: seconds since 1970 in UTC, without leap seconds.
// Ownership:    plain values.
// Threads:      any.
// Failure:      parse_utc() gives nullopt for anything that utc_text() never writes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dance {

std::int64_t utc_now_s();
// Whole minutes, rounded down; years 2000 to 9999.
std::string utc_text(std::int64_t utc_s);
std::optional<std::int64_t> parse_utc(std::string_view text);
std::string utc_shown(std::int64_t utc_s);

}  // namespace dance
