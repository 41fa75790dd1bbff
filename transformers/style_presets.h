// The styles that have a name: what a room or a guest asks for in one word.
//
// Units/frames: as core/pose/style.h.
// Ownership:    constants.
// Threads:      constants only.
// Failure:      find_style_preset() returns nullopt for an unknown name; style_preset_names() are those that there are.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/pose/style.h"

namespace dance {

// How much of what does not come again with the bar follows the gains, where nobody says: all of it shows more, and a
// sensor's noise too.
constexpr double kUsualMix = 0.5;

std::optional<Style> find_style_preset(std::string_view name);
// "calm, subtle, …"
std::string style_preset_names();

}  // namespace dance
