// The figures on this machine that the dance panel offers: those that ship with the program, and
// the files that this user has chosen before.
//
// Failure: folders that cannot be read have no figures.
#pragma once

#include <string>
#include <vector>

#include "core/store/avatar_store.h"
#include "viewer/dance_panel/own/figure_controller.h"

namespace dance {

// At most kMostStoredFigures of the store.
inline constexpr std::size_t kMostStoredFigures = 12;
std::vector<NamedFigure> figures_of(const AvatarStore& store, const std::string& shipped_folder);

}  // namespace dance
