// Skeleton: the dancer's own proportions on the canonical bones, so that feet stand on the floor
// and hands meet whatever the size of the body.
//
// Units/frames: metres; offset_m[b] is the origin of bone b from its parent's, in T-pose, axes of W
//               (the hips' entry is (0, standing height of the hips, 0)); tip_m is the end of an
//               end bone from that bone's origin.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      is_valid() is false for values that are not finite, or bones over 2 m.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/pose/bone.h"

namespace dance {

struct Skeleton {
  std::array<Eigen::Vector3f, kBoneCount> offset_m;
  std::array<Eigen::Vector3f, kTipCount> tip_m;
  std::uint32_t version = 0;

  const Eigen::Vector3f& offset(Bone bone) const { return offset_m[index_of(bone)]; }
  const Eigen::Vector3f& tip(Tip tip) const { return tip_m[static_cast<std::size_t>(tip)]; }
  float hips_height_m() const { return offset_m[0].y(); }
  bool operator==(const Skeleton&) const = default;
};

// An adult of the given height with average proportions: the default until a dancer's own arrive.
Skeleton average_skeleton(float height_m = 1.72f);

bool is_valid(const Skeleton& skeleton);

// From the floor to the top of the head in T-pose.
float standing_height_m(const Skeleton& skeleton);

}  // namespace dance
