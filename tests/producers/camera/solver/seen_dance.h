// Dances as a camera's network would see them, for tests of the solver: made, so that no data is
// needed.
//
// Units/frames: as testing/camera/capture_scene.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <cmath>
#include <vector>

#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/body_solver.h"
#include "producers/salsa/salsa_dancer.h"
#include "testing/camera/capture_scene.h"
#include "testing/camera/limb_joints.h"

namespace dance {

constexpr double kSeenHz = 30.0;

// One salsa dancer, at the camera's rate.
inline std::vector<Pose> salsa_poses(double seconds) {
  SalsaDancer dancer{SalsaStyle()};
  std::vector<Pose> poses(static_cast<std::size_t>(seconds * kSeenHz));
  for (std::size_t i = 0; i < poses.size(); ++i)
    dancer.dance_at(Duration::seconds(static_cast<double>(i) / kSeenHz), poses[i]);
  return poses;
}
inline Skeleton salsa_skeleton() { return SalsaDancer{SalsaStyle()}.skeleton(); }

inline CaptureScene salsa_scene(double seconds, const SceneErrors& errors,
                                const SceneCamera& camera = {}) {
  return make_scene("salsa", salsa_skeleton(), salsa_poses(seconds), kSeenHz, camera, errors, 7);
}

// The same pose all the time.
inline CaptureScene still_scene(const Pose& pose, double seconds, const SceneErrors& errors) {
  const std::vector<Pose> poses(static_cast<std::size_t>(seconds * kSeenHz), pose);
  return make_scene("still", average_skeleton(), poses, kSeenHz, SceneCamera(), errors, 7);
}

// Arms hanging, knees straight, on the floor.
inline Pose standing() {
  BodyState state = state_at_ease();
  for (BodyState::Side& side : state.sides) side.knee = 0.0;
  Pose pose;
  write_pose(state, pose);
  pose.p_WH_m.y() = salsa_skeleton().offset(Bone::kHips).y();
  return pose;
}

// Mean distance of the twelve joints of limbs from the truth, relative to the middle of the hips;
// the solver's stage leans by so much.
inline double joint_error_m(const SceneFrame& truth, const Skeleton& skeleton, const Pose& pose,
                            double lean_rad = 0.0) {
  const Eigen::AngleAxisd upright(lean_rad, Eigen::Vector3d::UnitX());
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const auto at = [&](Bone bone) { return frames.position(bone).cast<double>().eval(); };
  const Eigen::Vector3d hips = 0.5 * (at(Bone::kLeftUpperLeg) + at(Bone::kRightUpperLeg));
  const Eigen::Vector3d true_hips = 0.5 * (truth.truth_W_m[index_of(Landmark::kLeftHip)] +
                                           truth.truth_W_m[index_of(Landmark::kRightHip)]);
  double sum = 0.0;
  for (const auto& [landmark, bone] : kLimbJoints)
    sum += (upright * (at(bone) - hips) - (truth.truth_W_m[index_of(landmark)] - true_hips)).norm();
  return sum / static_cast<double>(kLimbJoints.size());
}

}  // namespace dance
