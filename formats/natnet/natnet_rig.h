// Which bones of a skeleton that Motive describes are which of ours, by their names: in Motive's
// own convention (Hip, Ab, Chest, LUArm, …), that of FBX (Hips, Spine, LeftArm, …) and that of BVH.
//
// Units/frames: ids of bones as frames carry them.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      a bone of another name is nobody's; a bone that is missing is absent.
// Source:       the conventions as OptiTrack's plugin for Unity maps them
//               (OptitrackSkeletonAnimator.cs), which also takes the bones to have no rotation in
//               T-pose.
#pragma once

#include <array>
#include <cstdint>

#include "core/pose/bone.h"
#include "formats/natnet/natnet_packet.h"

namespace dance {

struct NatNetRig {
  static constexpr std::int16_t kNone = -1;
  // Of each bone of the model, in its order.
  struct Part {
    std::int32_t id = 0;
    std::int16_t parent = kNone;  // index in `parts`
    std::int16_t bone = kNone;
    std::int16_t finger_bone = kNone;
    Eigen::Vector3f offset_m = Eigen::Vector3f::Zero();
  };
  FixedList<Part, kMostNatNetBones> parts;
  std::size_t bones_found = 0;

  std::int16_t part_of(std::int32_t id) const;
};

NatNetRig find_natnet_rig(const NatNetModel& model);

}  // namespace dance
