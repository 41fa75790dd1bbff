// The pieces of which a figure's surface is made in T-pose: tapered capsules with elliptic
// cross-sections, in layers of one material that grow together into one smooth surface.
//
// Units/frames: metres, W, T-pose with the middle of the floor below the hips at the origin.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

namespace dance {

enum class Material : std::uint8_t {
  kSkin,
  kTop,
  kLegs,
  kShoes,
  kSoles,
  kHair,
  kEyeWhite,
  kIris,
  kLips,
};
constexpr std::size_t kMaterialCount = 9;

// Parts of two limbs do not grow together, as thighs that nearly touch would; each grows into the
// trunk.
enum class FigureLimb : std::uint8_t { kTrunk, kLeftArm, kRightArm, kLeftLeg, kRightLeg };

// Two balls and the hull round them, stretched by `width` along `side` and by `depth` along the
// third direction.
struct FigurePart {
  Eigen::Vector3f a_m = Eigen::Vector3f::Zero();
  float radius_a_m = 0.0f;
  Eigen::Vector3f b_m = Eigen::Vector3f::Zero();
  float radius_b_m = 0.0f;
  Eigen::Vector3f side = Eigen::Vector3f::UnitX();
  float width = 1.0f;
  float depth = 1.0f;
  FigureLimb limb = FigureLimb::kTrunk;
};

// How a layer follows the bones: kHead the head alone, kNeck the head, the neck and the chest.
enum class FigureSkinning : std::uint8_t { kBody, kTop, kSkirt, kHead, kNeck, kFinger };

struct FigureLayer {
  Material material = Material::kSkin;
  float cell_m = 0.01f;   // about the length of its triangles
  float blend_m = 0.02f;  // how far parts grow together
  FigureSkinning skinning = FigureSkinning::kBody;
  std::size_t finger = 0;  // of kFinger: 0..9
  // Everything below is cut away: a skirt ends in a hem and not in a ball.
  float hem_y_m = -std::numeric_limits<float>::infinity();
  std::vector<FigurePart> parts;
};

}  // namespace dance
