// XrScene: where the points of a script are at a moment, and what the hands press.
//
// Units/frames: metres, seconds of the script; poses in the stage as it was at first.
// Ownership:    borrows the script.
// Threads:      none inside; const.
// Failure:      a point that is not there is lost; scripted poses may hold NaN or no rotation.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "testing/xr/script/xr_script.h"

namespace dance::test_xr {

using Pose = Eigen::Isometry3d;

struct PointState {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_radps = Eigen::Vector3d::Zero();
  Tracking tracking = Tracking::kLost;
};

inline Pose pose_of(const Eigen::Vector3d& p_m, const Eigen::Quaterniond& R) {
  Pose pose = Pose::Identity();
  pose.translate(p_m).rotate(R);
  return pose;
}
inline Pose pose_of(const PointState& state) { return pose_of(state.p_m, state.R); }

// From keyframes to a state; with NaN where the script wants it.
PointState point_at(const XrScript& script, TrackedPoint point, double time_s);
// The second is 0 but for the thumbstick.
std::array<float, 2> input_at(const XrScript& script, Hand hand, Input input, double time_s);
bool is_fist_at(const XrScript& script, double time_s);
// A tracker is connected from the time of its first keyframe on.
bool is_connected_at(const XrScript& script, TrackedPoint point, double time_s);

}  // namespace dance::test_xr
