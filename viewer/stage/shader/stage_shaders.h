// The GLSL of the stage, in pieces that link_program() puts together: light and shadow are written
// once and shared by floor and figures.
//
// Units/frames: metres in W; colours linear RGB until the last pass.
// Threads:      constants only.
// Failure:      none.
#pragma once

#include <string_view>

namespace dance::shaders {

// Number of shadow taps: paste one of them before kLight.
inline constexpr std::string_view kFewTaps = "#define SHADOW_TAPS 2\n";
inline constexpr std::string_view kManyTaps = "#define SHADOW_TAPS 16\n";

extern const std::string_view kLight;  // shade(), lit_by_key(), backdrop()
// figure_vertex(): a vertex of an AvatarModel where its joints take it; wants JOINTS_OF_A_VERTEX.
extern const std::string_view kFigureSkin;
extern const std::string_view kFigureVertex;  // after kFigureSkin
// After kLight. Wants HAS_PICTURE (0, 1), ALPHA (0 opaque, 1 mask, 2 blend), SHADING (0 lit,
// 1 toon, 2 unlit), HAS_SAMPLES and IS_FADING (0, 1).
extern const std::string_view kFigureFragment;
extern const std::string_view kFigureShadowVertex;    // after kFigureSkin
extern const std::string_view kFigureShadowFragment;  // wants HAS_PICTURE, ALPHA, IS_FADING
extern const std::string_view kFloorDetail;  // hash(), line(): precedes the fragments of floors
extern const std::string_view kFloorVertex;
extern const std::string_view kFloorFragment;  // after kLight, kFloorDetail; needs IS_PLAIN (0, 1)
extern const std::string_view kSpotVertex;
extern const std::string_view kSpotFragment;
extern const std::string_view kWaitingFragment;  // after kSpotVertex: a ring of light
extern const std::string_view kRibbonVertex;
extern const std::string_view kRibbonFragment;
extern const std::string_view kScreenVertex;      // one triangle over the whole picture
extern const std::string_view kBackdropFragment;  // after kLight
extern const std::string_view kPlaceVertex;
extern const std::string_view kPlaceFragment;
extern const std::string_view kPlaceFloorVertex;
extern const std::string_view kPlaceFloorFragment;  // as kFloorFragment; needs IS_TILES (0, 1) too
extern const std::string_view kHaloVertex;
extern const std::string_view kHaloFragment;
extern const std::string_view kLimbVertex;
extern const std::string_view kLimbFragment;
extern const std::string_view kSkyVertex;  // as kScreenVertex, behind all else
extern const std::string_view kSkyFragment;
extern const std::string_view kFinishFragment;  // tone, vignette, sRGB, dither

}  // namespace dance::shaders
