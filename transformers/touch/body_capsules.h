// BodyCapsules: a dancer's body as 22 capsules, one for each bone, with the dancer's own
// proportions: what two bodies touch with.
//
// Units/frames: metres in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      none; poses and proportions have been checked where they came in.
#pragma once

#include <array>

#include "core/pose/kinematics.h"

namespace dance {

struct Capsule {
  Eigen::Vector3f from, to;
  float radius_m = 0.0f;
};

// Where two capsules are nearest to each other; below 0 they overlap.
struct Nearness {
  float distance_m = 0.0f;
  Eigen::Vector3f place;  // between the two
};
Nearness nearness_of(const Capsule& a, const Capsule& b);

// Parts of the body, whose bones touch as one.
enum class BodyPart : std::uint8_t {
  kTrunk,
  kHead,
  kArmL,
  kHandL,
  kArmR,
  kHandR,
  kLegL,
  kLegR,
};
constexpr std::size_t kBodyParts = 8;
BodyPart part_of(Bone bone);

struct BodyCapsules {
  std::array<Capsule, kBoneCount> of_bone;
  static BodyCapsules of(const Skeleton& skeleton, const BodyFrames& frames);
};

}  // namespace dance
