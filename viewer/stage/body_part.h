// BodyPart: the one shape of which bodies are made, a tapered capsule with an elliptic
// cross-section, laid out as the vertex shader takes it, one instance each.
//
// Units/frames: metres in W; colours linear RGB.
// Ownership:    plain values; BodyParts keeps its memory from picture to picture.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dance {

// Two balls, the hull round them, and then that hull stretched across its axis: by `width` along
// `side` and by `depth` along the third direction. flat_* presses an end's cap in (0 = a disc).
struct BodyPart {
  Eigen::Vector3f a_W_m = Eigen::Vector3f::Zero();
  float radius_a_m = 0.0f;
  Eigen::Vector3f b_W_m = Eigen::Vector3f::Zero();
  float radius_b_m = 0.0f;
  Eigen::Vector3f side_W = Eigen::Vector3f::UnitX();
  float width = 1.0f;
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();
  float gloss = 0.1f;
  float flat_a = 1.0f;
  float flat_b = 1.0f;
  float depth = 1.0f;
  float opacity = 1.0f;
};
static_assert(sizeof(BodyPart) == 80, "five vec4 of the vertex shader");

// A dark spot on the floor under something that is close to it.
struct ContactSpot {
  Eigen::Vector3f centre_W_m;
  float half_length_m;
  Eigen::Vector3f along_W;  // unit, on the floor
  float half_width_m;
  float darkness;  // 0..1
};
static_assert(sizeof(ContactSpot) == 36);

struct BodyParts {
  std::vector<BodyPart> large;  // drawn with a fine mesh
  std::vector<BodyPart> small;  // fingers and faces: drawn with a coarse one
  std::vector<ContactSpot> spots;

  void clear() {
    large.clear();
    small.clear();
    spots.clear();
  }
};

}  // namespace dance
