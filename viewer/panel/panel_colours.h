// Colours of the panels over the stage.
//
// Units/frames: sRGB with alpha, as Dear ImGui packs it.
#pragma once

#include <imgui.h>

namespace dance::panel_colours {

constexpr ImU32 kText = IM_COL32(244, 245, 249, 255);
constexpr ImU32 kQuiet = IM_COL32(176, 182, 198, 255);
constexpr ImU32 kBackground = IM_COL32(13, 16, 24, 226);
constexpr ImU32 kGood = IM_COL32(95, 211, 141, 255);
constexpr ImU32 kFair = IM_COL32(255, 200, 87, 255);
constexpr ImU32 kBad = IM_COL32(255, 122, 110, 255);
constexpr ImU32 kAccent = IM_COL32(111, 183, 255, 255);
constexpr ImU32 kTrough = IM_COL32(255, 255, 255, 38);

}  // namespace dance::panel_colours
