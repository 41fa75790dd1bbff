#include "producers/camera/solver/body_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/pose/mirror.h"

namespace dance {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

Quaterniond about(const Vector3d& axis, double angle_rad) {
  return Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

void add_within(double step, double most, double& angle) {
  angle = std::clamp(angle + step, -most, most);
}

void add_within(const Vector3d& step, double most, Vector3d& rotation_vector) {
  rotation_vector += step;
  const double angle = rotation_vector.norm();
  if (angle > most) rotation_vector *= most / angle;
}

}  // namespace

Quaterniond turn_of(const Vector3d& v) {
  const double angle = v.norm();
  if (angle < 1e-9) return Quaterniond(1.0, 0.5 * v.x(), 0.5 * v.y(), 0.5 * v.z()).normalized();
  return Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

Vector3d vector_of(const Quaterniond& q) {
  const double sine = q.vec().norm();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < 1e-9) return 2.0 * sign * q.vec();
  return (2.0 * std::atan2(sine, std::abs(q.w())) * sign / sine) * q.vec();
}

void move(BodyState& state, const DofVector& step) {
  state.p_WH_m += step.segment<3>(dof::kPlace);
  state.R_WH = (state.R_WH * turn_of(step.segment<3>(dof::kHips))).normalized();
  add_within(step.segment<3>(dof::kSpine), kMostSpine_rad, state.spine);
  add_within(step.segment<3>(dof::kHead), kMostHead_rad, state.head);
  for (int s = 0; s < 2; ++s) {
    BodyState::Side& side = state.sides[static_cast<std::size_t>(s)];
    const auto d = step.segment<dof::kOfSide>(dof::side(s));
    add_within(d[dof::kShoulder], kMostShoulder_rad, side.shoulder_up);
    add_within(d[dof::kShoulder + 1], kMostShoulder_rad, side.shoulder_forward);
    side.upper_arm = (side.upper_arm * turn_of(d.template segment<3>(dof::kUpperArm))).normalized();
    side.elbow = std::clamp(side.elbow + d[dof::kElbow], 0.0, kMostElbow_rad);
    add_within(d[dof::kTurn], kMostTurn_rad, side.turn);
    add_within(d[dof::kHand], kMostHand_rad, side.hand_up);
    add_within(d[dof::kHand + 1], kMostHand_rad, side.hand_forward);
    side.upper_leg = (side.upper_leg * turn_of(d.template segment<3>(dof::kUpperLeg))).normalized();
    side.knee = std::clamp(side.knee + d[dof::kKnee], 0.0, kMostKnee_rad);
    side.foot = (side.foot * turn_of(d.template segment<3>(dof::kFoot))).normalized();
  }
}

DofVector step_between(const BodyState& from, const BodyState& to) {
  DofVector step;
  step.segment<3>(dof::kPlace) = to.p_WH_m - from.p_WH_m;
  step.segment<3>(dof::kHips) = vector_of(from.R_WH.conjugate() * to.R_WH);
  step.segment<3>(dof::kSpine) = to.spine - from.spine;
  step.segment<3>(dof::kHead) = to.head - from.head;
  for (int s = 0; s < 2; ++s) {
    const BodyState::Side& a = from.sides[static_cast<std::size_t>(s)];
    const BodyState::Side& b = to.sides[static_cast<std::size_t>(s)];
    auto d = step.segment<dof::kOfSide>(dof::side(s));
    d[dof::kShoulder] = b.shoulder_up - a.shoulder_up;
    d[dof::kShoulder + 1] = b.shoulder_forward - a.shoulder_forward;
    d.template segment<3>(dof::kUpperArm) = vector_of(a.upper_arm.conjugate() * b.upper_arm);
    d[dof::kElbow] = b.elbow - a.elbow;
    d[dof::kTurn] = b.turn - a.turn;
    d[dof::kHand] = b.hand_up - a.hand_up;
    d[dof::kHand + 1] = b.hand_forward - a.hand_forward;
    d.template segment<3>(dof::kUpperLeg) = vector_of(a.upper_leg.conjugate() * b.upper_leg);
    d[dof::kKnee] = b.knee - a.knee;
    d.template segment<3>(dof::kFoot) = vector_of(a.foot.conjugate() * b.foot);
  }
  return step;
}

void write_pose(const BodyState& state, Pose& pose) {
  const auto put = [&pose](std::size_t bone, const Quaterniond& q) {
    pose.R_PB[bone] = q.normalized().cast<float>();
  };
  pose.p_WH_m = state.p_WH_m.cast<float>();
  put(index_of(Bone::kHips), state.R_WH);
  const Quaterniond third = turn_of(state.spine / 3.0), half = turn_of(state.head / 2.0);
  for (const Bone bone : {Bone::kSpine, Bone::kChest, Bone::kUpperChest})
    put(index_of(bone), third);
  for (const Bone bone : {Bone::kNeck, Bone::kHead}) put(index_of(bone), half);
  for (std::size_t s = 0; s < 2; ++s) {
    const BodyState::Side& side = state.sides[s];
    const double sign = s == 0 ? 1.0 : -1.0;
    const std::size_t arm = index_of(s == 0 ? Bone::kLeftShoulder : Bone::kRightShoulder);
    const std::size_t leg = index_of(s == 0 ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg);
    const Quaterniond turned = about(Vector3d::UnitX(), 0.5 * side.turn);
    put(arm, about(Vector3d::UnitZ(), sign * side.shoulder_up) *
                 about(Vector3d::UnitY(), -sign * side.shoulder_forward));
    put(arm + 1, side.upper_arm);
    put(arm + 2, about(Vector3d::UnitY(), -sign * side.elbow) * turned);
    put(arm + 3, turned * about(Vector3d::UnitZ(), sign * side.hand_up) *
                     about(Vector3d::UnitY(), -sign * side.hand_forward));
    put(leg, side.upper_leg);
    put(leg + 1, about(Vector3d::UnitX(), side.knee));
    put(leg + 2, side.foot);
    put(leg + 3, Quaterniond::Identity());
  }
}

void mirror(Pose& pose) {
  for (auto& q : pose.R_PB) q = mirrored(q);
  pose.p_WH_m = mirrored(pose.p_WH_m);
  std::uint32_t presence = pose.presence & ((1u << index_of(Bone::kLeftShoulder)) - 1);
  for (const Bone first : {Bone::kLeftShoulder, Bone::kLeftUpperLeg}) {
    for (std::size_t i = index_of(first); i < index_of(first) + 4; ++i) {
      std::swap(pose.R_PB[i], pose.R_PB[i + 4]);
      presence |= (pose.presence >> i & 1u) << (i + 4) | (pose.presence >> (i + 4) & 1u) << i;
    }
  }
  pose.presence = presence;
}

}  // namespace dance
