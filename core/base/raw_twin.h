// A dancer may be on a stage twice for comparison: NAME as the house's routes show it, and its raw
// twin NAME-raw as the poses came. Displays show one of the two, or both side by side; raw twins do
// not count as guests.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   a name too long for the suffix has no twin.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/guest_id.h"

namespace dance {

constexpr std::string_view kRawTwinEnding = "-raw";

inline std::optional<GuestId> raw_twin_of(const GuestId& guest) {
  return GuestId::parse(std::string(guest.view()) + std::string(kRawTwinEnding));
}

// The guest whose twin this is; nullopt without the suffix.
inline std::optional<GuestId> twin_of_whom(const GuestId& twin) {
  const std::string_view name = twin.view();
  if (!name.ends_with(kRawTwinEnding)) return std::nullopt;
  return GuestId::parse(name.substr(0, name.size() - kRawTwinEnding.size()));
}

}  // namespace dance
