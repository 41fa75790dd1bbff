// Positions and rotations in Unity's axes, which VMC and VRChat use: left-handed, +Y up, metres, a
// dancer in T-pose faces +Z and has -X at the left hand. W is right-handed and has +X there: one
// axis is mirrored. The same function leads there and back.
//
// Units/frames: metres; quaternions.
// Threads:      none inside.
// Failure:      none.
// Source:       a mirror image of x turns (qx, qy, qz, qw) into (qx, -qy, -qz, qw).
#pragma once

#include <Eigen/Geometry>

namespace dance {

inline Eigen::Vector3f other_hand(const Eigen::Vector3f& p_m) {
  return {-p_m.x(), p_m.y(), p_m.z()};
}
inline Eigen::Quaternionf other_hand(const Eigen::Quaternionf& R) {
  return {R.w(), R.x(), -R.y(), -R.z()};
}

}  // namespace dance
