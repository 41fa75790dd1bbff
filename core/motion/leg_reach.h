// Puts feet back where they shall stand after hips or legs were moved: two-bone IK from hip to
// ankle that keeps the knee's side and the twist of thigh and shank.
//
// Units/frames: metres in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      the leg stretches towards a foot out of reach; the remaining distance is returned.
#pragma once

#include "core/pose/kinematics.h"

namespace dance {

// How far the hips must come down so that the legs reach their ankles, 0 where they do: no
// straighter than in `like`, or than nearly straight. A leg is weighted by the load it carries, 0 …
// 1.
float needed_drop_m(const Skeleton& skeleton, const BodyFrames& like,
                    const std::array<Eigen::Vector3f, 2>& hip_joints_W_m,
                    const std::array<Eigen::Vector3f, 2>& ankles_W_m,
                    const std::array<float, 2>& carries);

// Turns thigh, shank and foot of `pose` so that the ankle comes to target and the foot stands as
// R_WFoot. `like` is the body whose knee and twist the leg takes over. The parents' frames must be
// current; the leg's are updated.
float reach_ankle(const Skeleton& skeleton, const Limb& leg, const BodyFrames& like,
                  const Eigen::Vector3f& target_W_m, const Eigen::Quaternionf& R_WFoot, Pose& pose,
                  BodyFrames& frames);

}  // namespace dance
