// Venue: the room that a stage is shown in, with the names that options, house files and windows
// use.
//
// Threads: constants only.
// Failure: parse_place() is nullopt for other names; kPlaceList is for the error.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace dance {

// kPlain is a disc of light without walls, for measurements and pictures that are compared.
enum class Venue { kPlain, kStudio, kBar, kTerrace };

struct PlaceName {
  Venue place;
  std::string_view option;
};

constexpr std::array<PlaceName, 4> kPlaceNames{{
    {Venue::kPlain, "plain"},
    {Venue::kStudio, "studio"},
    {Venue::kBar, "bar"},
    {Venue::kTerrace, "terrace"},
}};
constexpr std::string_view kPlaceList = "studio, bar, terrace, plain";

constexpr std::string_view name_of(Venue place) {
  return kPlaceNames[static_cast<std::size_t>(place)].option;
}

constexpr std::optional<Venue> parse_place(std::string_view name) {
  for (const PlaceName& it : kPlaceNames)
    if (it.option == name) return it.place;
  return std::nullopt;
}

constexpr Venue next_place(Venue place, int step) {
  constexpr int kCount = static_cast<int>(kPlaceNames.size());
  return static_cast<Venue>((static_cast<int>(place) + step % kCount + kCount) % kCount);
}

}  // namespace dance
