#include "producers/trackers/calibration/standing_body.h"

#include <algorithm>

#include "core/pose/heading.h"
#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kStandingReference_m = 1.72f;
// Feet point outward when people stand; a tracker is worn on the instep, before the ankle.
constexpr float kToesOut_rad = 0.09f, kInstep_m = 0.06f;
// Arms that hang, from the T-pose: down, and a little forward.
constexpr float kArmsDown_rad = 1.05f, kArmsForward_rad = 0.35f;

bool is_left(TrackedPoint point) {
  return point == TrackedPoint::kLeftHand || point == TrackedPoint::kLeftElbow ||
         point == TrackedPoint::kLeftFoot || point == TrackedPoint::kLeftKnee;
}

Quaternionf turned_towards(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return (shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R).normalized();
}

}  // namespace

StandingBody::StandingBody(const Skeleton& skeleton, const BonePlaces& devices,
                           const Quaternionf& R_WFacing, const Mount& head, Arms arms)
    : devices_(devices),
      R_WFacing_(R_WFacing),
      arms_(arms),
      scale_(standing_height_m(skeleton) / kStandingReference_m) {
  Pose pose;
  pose.R_PB[0] = R_WFacing;
  pose.p_WH_m = Vector3f::Zero();
  forward_kinematics(skeleton, pose, frames_);
  const Vector3f eyes = frames_.position(Bone::kHead) + R_WFacing * head.p_BT_m;
  const Vector3f moved = devices.of(TrackedPoint::kHead).p_W_m - eyes;
  for (Vector3f& p : frames_.p_WB_m) p += moved;
  for (Vector3f& p : frames_.p_WT_m) p += moved;
}

Vector3f StandingBody::shoulder(TrackedPoint hand) const {
  return frames_.position(is_left(hand) ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
}

Quaternionf StandingBody::arm_turn(TrackedPoint point) const {
  const bool left = is_left(point);
  const Vector3f along = R_WFacing_ * (left ? Vector3f::UnitX() : Vector3f(-Vector3f::UnitX()));
  const TrackedPoint hand = left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand;
  if (arms_ == Arms::kHang) {
    const float side = left ? 1.0f : -1.0f;
    const Eigen::AngleAxisf down(-side * kArmsDown_rad, Vector3f::UnitZ());
    const Eigen::AngleAxisf forward(-kArmsForward_rad, Vector3f::UnitX());
    return R_WFacing_ * Quaternionf(forward) * Quaternionf(down);
  }
  if (!devices_.has(hand)) return R_WFacing_;
  return turned_towards(along, devices_.of(hand).p_W_m - shoulder(hand), R_WFacing_);
}

Vector3f StandingBody::wrist(TrackedPoint hand) const {
  const Mount nominal = nominal_mount(hand, scale_ * kStandingReference_m);
  return devices_.of(hand).p_W_m - arm_turn(hand) * nominal.p_BT_m;
}

Place StandingBody::foot(TrackedPoint point) const {
  const bool left = is_left(point);
  const Bone bone = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const Vector3f hips = frames_.p_WB_m[0];
  const Vector3f model = R_WFacing_.conjugate() * (frames_.position(bone) - hips);
  const Vector3f device = R_WFacing_.conjugate() * (devices_.of(point).p_W_m - hips);
  // Under the dancer by the model, ahead of it by the device: either may be off by centimetres.
  Vector3f ankle(device.x(), 0.0f, 0.5f * (model.z() + device.z() - scale_ * kInstep_m));
  ankle = hips + R_WFacing_ * ankle;
  ankle.y() = 0.08f * scale_;
  return {ankle, R_WFacing_ * about_up(left ? kToesOut_rad : -kToesOut_rad)};
}

Place StandingBody::thigh(TrackedPoint point) const {
  const bool left = is_left(point);
  const TrackedPoint foot_point = left ? TrackedPoint::kLeftFoot : TrackedPoint::kRightFoot;
  const Vector3f hip = frames_.position(left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg);
  if (!devices_.has(foot_point)) return {hip, R_WFacing_};
  const Vector3f to_ankle = foot(foot_point).p_W_m - hip;
  return {hip, turned_towards(-Vector3f::UnitY(), to_ankle, R_WFacing_)};
}

Place StandingBody::bone(TrackedPoint point) const {
  switch (point) {
    case TrackedPoint::kLeftHand:
    case TrackedPoint::kRightHand:
      return {wrist(point), arm_turn(point)};
    case TrackedPoint::kLeftElbow:
    case TrackedPoint::kRightElbow:
      return {shoulder(point), arm_turn(point)};
    case TrackedPoint::kLeftFoot:
    case TrackedPoint::kRightFoot:
      return foot(point);
    case TrackedPoint::kLeftKnee:
    case TrackedPoint::kRightKnee:
      return thigh(point);
    default:
      return {frames_.position(kPointBones[index_of(point)]), R_WFacing_};
  }
}

}  // namespace dance
