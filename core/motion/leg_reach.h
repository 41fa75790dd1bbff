// Puts feet back where they are to stand after the hips, or the legs themselves, were moved: the
// leg is bent anew between hip and ankle, its knee to the side it was, thigh and shank with the
// twist that they had.
//
// Units/frames: metres in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      a foot out of reach is reached towards; the distance that is left is returned.
#pragma once

#include "core/pose/kinematics.h"

namespace dance {

// By how much hips have to come down so that legs reach their ankles again, 0 where they do: no
// straighter than in `like`, or than nearly straight. A leg counts as much as it carries, 0 … 1.
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
