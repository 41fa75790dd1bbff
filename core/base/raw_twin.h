// A dancer may stand on a stage twice: NAME as the house's routes show the dance, and NAME-raw as
// its poses came, for whoever wants to see what the routes do. Displays show one of the two, or
// both side by side; nobody counts twins as guests.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   a name that leaves no room for the ending has no twin.
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

// Whose twin it is; nothing where the name has not the ending.
inline std::optional<GuestId> twin_of_whom(const GuestId& twin) {
  const std::string_view name = twin.view();
  if (!name.ends_with(kRawTwinEnding)) return std::nullopt;
  return GuestId::parse(name.substr(0, name.size() - kRawTwinEnding.size()));
}

}  // namespace dance
