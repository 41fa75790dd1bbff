#include "testing/camera/capture_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/assert.h"
#include "core/pose/interpolate.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// C's axes in W, of a camera that looks along −z: x right, y down, z away.
Matrix3d axes_of(const SceneCamera& camera) {
  const Matrix3d tilt = (Eigen::AngleAxisd(-camera.pitch_rad, Vector3d::UnitX()) *
                         Eigen::AngleAxisd(camera.roll_rad, Vector3d::UnitZ()))
                            .toRotationMatrix();
  Matrix3d upright;
  upright.col(0) = Vector3d::UnitX();
  upright.col(1) = -Vector3d::UnitY();
  upright.col(2) = -Vector3d::UnitZ();
  return tilt * upright;
}

// A heel is behind its ankle by this share of what its toes are before it.
constexpr float kHeelShare = 0.24f;

}  // namespace

double lowest_sole_m(const Skeleton& skeleton, const BodyFrames& frames) {
  float lowest = std::min(frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y());
  for (const auto& [foot, toes, tip] :
       {std::tuple{Bone::kLeftFoot, Bone::kLeftToes, Tip::kLeftToes},
        std::tuple{Bone::kRightFoot, Bone::kRightToes, Tip::kRightToes}}) {
    const Eigen::Vector3f &joint = skeleton.offset(toes), &end = skeleton.tip(tip);
    const float under = joint.y() + end.y();
    for (const float z : {joint.z(), -kHeelShare * (joint.z() + end.z())}) {
      const Eigen::Vector3f sole =
          frames.position(foot) + frames.R_WB[index_of(foot)] * Eigen::Vector3f(0.0f, under, z);
      lowest = std::min(lowest, sole.y());
    }
  }
  return static_cast<double>(lowest);
}

CaptureScene make_scene(const std::string& name, const Skeleton& skeleton,
                        const std::vector<Pose>& poses, double hz, const SceneCamera& camera,
                        const SceneErrors& errors, std::uint64_t seed) {
  DANCE_ASSERT(!poses.empty() && hz > 0.0, poses.size(), hz);
  CaptureScene scene;
  scene.name = name;
  scene.hz = hz;
  scene.camera = camera;
  scene.height_m = static_cast<double>(standing_height_m(skeleton));
  SceneNetwork network(errors, hz, seed);
  Vector3d middle = Vector3d::Zero();
  for (const Pose& pose : poses)
    middle += pose.p_WH_m.cast<double>() / static_cast<double>(poses.size());
  if (camera.middle_m) middle = *camera.middle_m;
  // The take's W with its middle before the camera; the camera looks along −z.
  scene.R_WC = axes_of(camera);
  Vector3d eye(middle.x(), camera.height_m, middle.z() + camera.distance_m);
  BodyFrames frames;
  Vector3d origin = Vector3d::Zero();
  for (std::size_t f = 0; f < poses.size(); ++f) {
    forward_kinematics(skeleton, poses[f], frames);
    SceneFrame frame;
    frame.truth_W_m = points_of(frames, scene.height_m, network);
    if (f == 0) {
      origin = 0.5 * (frame.truth_W_m[index_of(Landmark::kLeftHip)] +
                      frame.truth_W_m[index_of(Landmark::kRightHip)]);
      origin.y() = 0.0;
      eye -= origin;
      scene.p_WC_m = eye;
      scene.origin_m = origin;
      scene.middle_W_m = middle - origin;
    }
    std::array<Vector3d, kLandmarkCount> p_C;
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
      frame.truth_W_m[i] -= origin;
      p_C[i] = scene.R_WC.transpose() * (frame.truth_W_m[i] - eye);
    }
    frame.ball_W_m = {frames.position(Bone::kLeftToes).cast<double>() - origin,
                      frames.position(Bone::kRightToes).cast<double>() - origin};
    frame.lowest_sole_m = lowest_sole_m(skeleton, frames);
    frame.landmarks = network.see(
        p_C, camera.pinhole, MonoTime() + Duration::seconds(1.0 + static_cast<double>(f) / hz));
    frame.is_flipped = network.is_flipped();
    scene.frames.push_back(frame);
  }
  return scene;
}

EyeScene make_eye(const CaptureScene& first, const Skeleton& skeleton,
                  const std::vector<Pose>& poses, double poses_hz, const SceneEye& eye,
                  const SceneErrors& errors, std::uint64_t seed) {
  DANCE_ASSERT(!poses.empty() && poses_hz > 0.0 && eye.hz > 0.0, poses.size(), poses_hz);
  EyeScene scene;
  scene.eye = eye;
  const Matrix3d around = Eigen::AngleAxisd(eye.around_rad, Vector3d::UnitY()).toRotationMatrix();
  scene.R_WC = around * axes_of(eye.camera);
  scene.p_WC_m = first.middle_W_m + around * Vector3d(0.0, 0.0, eye.camera.distance_m);
  scene.p_WC_m.y() = eye.camera.height_m;
  SceneNetwork network(errors, eye.hz, seed);
  BodyFrames frames;
  const double length_s = static_cast<double>(poses.size() - 1) / poses_hz;
  for (int k = 0;; ++k) {
    const double moment_s = eye.phase_s + k / eye.hz;
    if (moment_s >= length_s) break;
    const double place = moment_s * poses_hz;
    const auto before = static_cast<std::size_t>(place);
    const Pose pose = interpolate(poses[before], poses[before + 1],
                                  static_cast<float>(place - static_cast<double>(before)));
    forward_kinematics(skeleton, pose, frames);
    std::array<Vector3d, kLandmarkCount> p_C = points_of(frames, first.height_m, network);
    for (Vector3d& p : p_C) p = scene.R_WC.transpose() * (p - first.origin_m - scene.p_WC_m);
    EyeScene::Moment moment;
    moment.time = MonoTime() + Duration::seconds(1.0 + moment_s);
    moment.landmarks = network.see(p_C, eye.camera.pinhole,
                                   moment.time + Duration::seconds(scene.later_s(moment_s)));
    scene.moments.push_back(moment);
  }
  return scene;
}

}  // namespace dance
