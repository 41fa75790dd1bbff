// A plausible hand: where OpenXR's 26 joints are in the grip pose of a hand that is flat or a fist.
//
// Units/frames: metres; joints in the grip's frame G. As in OpenXR each joint has -Z towards the
//               finger's tip and +Y out of the back of the hand.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <array>

#include "testing/xr/script/xr_scene.h"

namespace dance::test_xr {

constexpr std::size_t kHandJoints = 26;

struct HandSkeleton {
  std::array<Pose, kHandJoints> T_GJ;
  std::array<float, kHandJoints> radius_m;
};
HandSkeleton hand_skeleton(Hand hand, bool is_fist);

}  // namespace dance::test_xr
