// The GLSL of the stage, in pieces that link_program() puts together: light and shadow are written
// once and shared by floor and bodies.
//
// Units/frames: metres in W; colours linear RGB until the last pass.
// Threads:      constants only.
// Failure:      none.
#pragma once

#include <string_view>

namespace dance::shaders {

// Number of shadow taps: paste one of them before kLight.
inline constexpr std::string_view kFewTaps = "#define SHADOW_TAPS 4\n";
inline constexpr std::string_view kManyTaps = "#define SHADOW_TAPS 16\n";

extern const std::string_view kLight;           // shade(), lit_by_key(), backdrop()
extern const std::string_view kPartShape;       // part_point(): a vertex of a body part
extern const std::string_view kBodyVertex;      // after kPartShape
extern const std::string_view kBodyFragment;    // after kLight
extern const std::string_view kShadowVertex;    // after kPartShape
extern const std::string_view kShadowFragment;  // depth only
extern const std::string_view kFloorVertex;
extern const std::string_view kFloorFragment;  // after kLight
extern const std::string_view kSpotVertex;
extern const std::string_view kSpotFragment;
extern const std::string_view kScreenVertex;      // one triangle over the whole picture
extern const std::string_view kBackdropFragment;  // after kLight
extern const std::string_view kFinishFragment;    // tone, vignette, sRGB, dither

}  // namespace dance::shaders
