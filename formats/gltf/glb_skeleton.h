// The joints of a dancer in a GLB, in T-pose: the bones of the body, those of the fingers where
// they were recorded, and the ends of the last bones, which programs need to draw those.
//
// Units/frames: metres; offset_m from the parent's origin, place_m from the middle of the floor
//               below the hips; axes of W.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/pose/skeleton.h"

namespace dance {

struct GlbJoint {
  std::string name;
  int parent = -1;  // index, smaller than the joint's own; -1 for the hips
  Eigen::Vector3f offset_m;
  Eigen::Vector3f place_m;
};

// Joint b is bone b; with hands joint kBoneCount + f is finger bone f; the ends come last.
std::vector<GlbJoint> glb_joints(const Skeleton& skeleton, bool has_hands);

}  // namespace dance
