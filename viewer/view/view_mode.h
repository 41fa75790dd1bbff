// ViewMode: how a stage is looked at, with the names that options and pictures use.
//
// Threads: constants only.
// Failure: none.
#pragma once

#include <array>
#include <string_view>

namespace dance {

enum class ViewMode { kOrbit, kFollow, kMirror, kFirstPerson, kCompare, kGrid };

struct ViewName {
  ViewMode mode;
  std::string_view option;  // of --view
};

constexpr std::array<ViewName, 6> kViewNames{{
    {ViewMode::kOrbit, "orbit"},
    {ViewMode::kFollow, "follow"},
    {ViewMode::kMirror, "mirror"},
    {ViewMode::kFirstPerson, "first-person"},
    {ViewMode::kCompare, "compare"},
    {ViewMode::kGrid, "grid"},
}};

constexpr const ViewName& name_of(ViewMode mode) {
  return kViewNames[static_cast<std::size_t>(mode)];
}

// Views of one dancer.
constexpr bool is_of_one(ViewMode mode) {
  return mode == ViewMode::kFollow || mode == ViewMode::kMirror || mode == ViewMode::kFirstPerson;
}

}  // namespace dance
