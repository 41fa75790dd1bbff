// FigureFit: one figure while it is being put onto the stage: where the dancer's bones are, and
// where the avatar's have come to be so far.
//
// Units/frames: metres in W.
// Ownership:    plain values; refers to the rig.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>

#include "viewer/figure/limb_fit.h"
#include "viewer/figure/rig/avatar_rig.h"

namespace dance {

constexpr std::array<Limb, 2> kArmLimbs{kLeftArm, kRightArm};
constexpr std::array<Limb, 2> kLegLimbs{kLeftLeg, kRightLeg};

// What contacts keep of a figure from picture to picture.
struct ContactPast {
  std::array<Eigen::Vector3f, 2> corrections_W_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  std::array<LimbSide, 2> elbows;
  float passed_s = 0.0f;
  bool is_known = false;
};

struct FigureFit {
  const AvatarRig* rig = nullptr;
  BodyFrames danced;
  BodyFrames frames;
  std::array<float, 2> arm_stretch{1.0f, 1.0f};
  ContactPast* past = nullptr;  // null: none is kept

  const Eigen::Quaternionf& R_W(Bone bone) const { return frames.R_WB[index_of(bone)]; }
  Eigen::Vector3f palm_W_m(std::size_t side) const {
    return frames.position(kArmLimbs[side].end) + R_W(kArmLimbs[side].end) * rig->palms_m[side];
  }
  Eigen::Vector3f danced_palm_W_m(std::size_t side) const {
    return danced.position(kArmLimbs[side].end) +
           danced.R_WB[index_of(kArmLimbs[side].end)] * rig->dancer_palms_m[side];
  }
};

// Rises smoothly from 0 at `low` to 1 at `high`; with high < low it falls from 1 to 0.
inline float smooth_between(float low, float high, float value) {
  const float t = std::min(1.0f, std::max(0.0f, (value - low) / (high - low)));
  return t * t * (3.0f - 2.0f * t);
}

// The dancer's pose on the avatar's bones, hips over the same place.
void place_on_bones(const Skeleton& dancer, const Pose& pose, FigureFit& fit);

}  // namespace dance
