#include "transformers/tempo/motion_channels.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A foot is not faster than this; what is, is the sensor's error.
constexpr float kFastestFoot_m_s = 2.5f;
// Steps of a dance peak at about 2 m/s, and sway a few centimetres.
constexpr float kSpeedAsPlace_s = 0.05f;
constexpr float kTiltAsPlace_m = 0.3f;

}  // namespace

MotionChannels::MotionChannels() : skeleton_(average_skeleton()) {}

const MotionFrame& MotionChannels::take(const Pose& pose) {
  const double dt_s = (pose.capture_time - frame_.time).as_seconds();
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (pose.presence >> b & 1u) seen_.R_PB[b] = pose.R_PB[b];
  seen_.p_WH_m = pose.p_WH_m;
  forward_kinematics(skeleton_, seen_, frames_);

  const Vector3f facing = frames_.R_WB[0] * Vector3f::UnitZ();
  const float level = std::hypot(facing.x(), facing.z());
  const Vector3f z = level > 1e-3f ? Vector3f(facing.x() / level, 0.0f, facing.z() / level)
                                   : Vector3f(Vector3f::UnitZ());
  const Vector3f x(z.z(), 0.0f, -z.x());

  std::size_t next = 0;
  const auto put = [&](const Vector3f& v_W) {
    frame_.channel[next++] = x.dot(v_W);
    frame_.channel[next++] = v_W.y();
    frame_.channel[next++] = z.dot(v_W);
  };
  const auto at = [&](Bone bone) -> const Vector3f& { return frames_.position(bone); };
  const Vector3f feet = 0.5f * (at(Bone::kLeftFoot) + at(Bone::kRightFoot));
  put(at(Bone::kHips) - feet);
  frame_.sway_m = frame_.channel[0];
  const Vector3f up = frames_.R_WB[0] * Vector3f::UnitY();
  frame_.channel[next++] = kTiltAsPlace_m * x.dot(up);
  frame_.channel[next++] = kTiltAsPlace_m * z.dot(up);
  put(at(Bone::kUpperChest) - at(Bone::kHips));
  put(at(Bone::kLeftUpperArm) - at(Bone::kUpperChest));
  put(at(Bone::kRightUpperArm) - at(Bone::kUpperChest));
  put(at(Bone::kLeftLowerArm) - at(Bone::kLeftUpperArm));
  put(at(Bone::kRightLowerArm) - at(Bone::kRightUpperArm));
  put(at(Bone::kLeftHand) - at(Bone::kLeftLowerArm));
  put(at(Bone::kRightHand) - at(Bone::kRightLowerArm));
  put(at(Bone::kLeftLowerLeg) - at(Bone::kHips));
  put(at(Bone::kRightLowerLeg) - at(Bone::kHips));
  put(at(Bone::kLeftFoot) - at(Bone::kRightFoot));
  put(at(Bone::kHead) - at(Bone::kUpperChest));

  const std::array<Vector3f, 2> p_WFoot_m{at(Bone::kLeftFoot), at(Bone::kRightFoot)};
  if (has_last_ && dt_s > 0.0) {
    float together = 0.0f, faster = 0.0f;
    for (std::size_t side = 0; side < 2; ++side) {
      const float speed =
          std::min(kFastestFoot_m_s,
                   (p_WFoot_m[side] - frame_.p_WFoot_m[side]).norm() / static_cast<float>(dt_s));
      together += speed;
      faster = std::max(faster, speed);
    }
    frame_.channel[next] = kSpeedAsPlace_s * together;
    frame_.channel[next + 1] = kSpeedAsPlace_s * faster;
  }
  frame_.p_WFoot_m = p_WFoot_m;
  frame_.time = pose.capture_time;
  frame_.music_beats = pose.music_beats;
  has_last_ = true;
  return frame_;
}

}  // namespace dance
