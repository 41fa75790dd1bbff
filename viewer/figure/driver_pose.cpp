#include "viewer/figure/driver_pose.h"

#include <cmath>
#include <numbers>

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFreeTwist_rad = 2.1f;  // up to here as danced
// So far the twist may go on past half a turn before it is taken as coming from the other side.
constexpr float kFurthestTwist_rad = 1.7f * kPi;

float wrapped(float angle) { return std::remainder(angle, 2.0f * kPi); }

float saturated_twist(float twist) {
  const float size = std::abs(twist), room = kMostForearmTwist_rad - kFreeTwist_rad;
  if (size <= kFreeTwist_rad) return twist;
  return std::copysign(kFreeTwist_rad + room * (1.0f - std::exp((kFreeTwist_rad - size) / room)),
                       twist);
}

Quaternionf about(const Vector3f& axis, float angle) {
  return Quaternionf(Eigen::AngleAxisf(angle, axis));
}

Vector3f direction(const AvatarShape& shape, Bone from, Bone to) {
  const Vector3f along = shape.at(to) - shape.at(from);
  const float length = along.norm();
  return length > 1e-5f ? Vector3f(along / length) : Vector3f(Vector3f::UnitX());
}

int helpers_of(const AvatarShape& shape, Bone bone) {
  int count = 0;
  for (const TwistNode& twist : shape.twists) count += twist.bone == bone;
  return count;
}

struct ForearmTurns {
  Quaternionf upper, lower, hand;  // D
  Vector3f axis;                   // of the forearm, in M
  float at_elbow, at_wrist;
};

ForearmTurns turns_of(const FigureFit& fit, std::size_t side) {
  const Limb& arm = kArmLimbs[side];
  const auto D = [&](Bone bone) { return Quaternionf(fit.R_W(bone) * fit.rig->C[index_of(bone)]); };
  ForearmTurns turns;
  turns.upper = D(arm.upper);
  turns.lower = D(arm.lower);
  turns.hand = D(arm.end);
  turns.axis = direction(*fit.rig->shape, arm.lower, arm.end);
  turns.at_elbow = twist_rad(turns.upper.conjugate() * turns.lower, turns.axis);
  turns.at_wrist = twist_rad(turns.lower.conjugate() * turns.hand, turns.axis);
  return turns;
}

// In equal steps; the twist may lie some whole turns away from what the two joints say.
void share_forearm_twist(std::size_t side, float twist, FigureFit& fit,
                         std::span<DriverPose> drivers) {
  const Limb& arm = kArmLimbs[side];
  const ForearmTurns turns = turns_of(fit, side);
  twist += wrapped(turns.at_elbow + turns.at_wrist - twist);
  if (const float most = kMostForearmTwist_rad; std::abs(twist) > most) {  // after contacts
    const std::size_t hand = index_of(arm.end);
    const Quaternionf back = about(turns.lower * turns.axis, std::copysign(most, twist) - twist);
    drivers[hand].D = (back * drivers[hand].D).normalized();
    fit.frames.R_WB[hand] = (back * fit.frames.R_WB[hand]).normalized();
    twist = std::copysign(most, twist);
  }
  const float step = twist / static_cast<float>(helpers_of(*fit.rig->shape, arm.lower) + 2);
  const std::size_t lower = index_of(arm.lower);
  drivers[lower].D = (turns.lower * about(turns.axis, step - turns.at_elbow)).normalized();
  fit.frames.R_WB[lower] = (drivers[lower].D * fit.rig->C[lower].conjugate()).normalized();
}

// Of a hand at rest, for each bone of a finger, and of a thumb.
constexpr std::array<float, 3> kRestingCurl_rad{0.3f, 0.38f, 0.25f};
constexpr std::array<float, 3> kRestingThumb_rad{0.12f, 0.15f, 0.1f};

std::array<Quaternionf, kFingerBoneCount> resting_fingers() {
  std::array<Quaternionf, kFingerBoneCount> fingers;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const bool left = f < kFingerBoneCount / 2;
    const bool thumb = f % (kFingerBoneCount / 2) < 3;
    const float curl = (thumb ? kRestingThumb_rad : kRestingCurl_rad)[f % 3];
    // Palms face down in T-pose: fingers curl from ±X to -Y, thumbs from +Z towards the fingers.
    const float side = left ? 1.0f : -1.0f;
    const Vector3f axis = thumb ? Vector3f(0.0f, side, 0.0f) : Vector3f(0.0f, 0.0f, -side);
    fingers[f] = about(axis, curl);
  }
  return fingers;
}

}  // namespace

float twist_rad(const Quaternionf& q, const Vector3f& axis) {
  return wrapped(2.0f * std::atan2(q.vec().dot(axis), q.w()));
}

DriverPose following(const AvatarRig& rig, std::size_t driver, std::size_t leader,
                     const DriverPose& leader_pose) {
  const Vector3f apart = rig.shape->drivers_M_m[driver] - rig.shape->drivers_M_m[leader];
  return {leader_pose.D, leader_pose.place_W_m + rig.scale * (leader_pose.D * apart)};
}

void limit_hand_twist(FigureFit& fit, ForearmTwists& twists) {
  for (std::size_t side = 0; side < 2; ++side) {
    const ForearmTurns turns = turns_of(fit, side);
    float twist = wrapped(turns.at_elbow + turns.at_wrist);
    if (twists.is_known) {
      twist = twists.danced_rad[side] + wrapped(twist - twists.danced_rad[side]);
      if (std::abs(twist) > kFurthestTwist_rad) twist = wrapped(twist);
    }
    twists.danced_rad[side] = twist;
    twists.shown_rad[side] = saturated_twist(twist);
    if (twists.shown_rad[side] == twist) continue;
    auto& R_W = fit.frames.R_WB[index_of(kArmLimbs[side].end)];
    const Quaternionf back = about(turns.lower * turns.axis, twists.shown_rad[side] - twist);
    R_W = (back * R_W).normalized();
  }
  twists.is_known = true;
}

void drive_bones(FigureFit& fit, const ForearmTwists& twists, bool shares_twist,
                 std::span<DriverPose> drivers) {
  for (std::size_t b = 0; b < kBoneCount; ++b)
    drivers[b] = {(fit.frames.R_WB[b] * fit.rig->C[b]).normalized(), fit.frames.p_WB_m[b]};
  if (!shares_twist) return;
  for (std::size_t side = 0; side < 2; ++side)
    share_forearm_twist(side, twists.shown_rad[side], fit, drivers);
}

void drive_fingers(const AvatarRig& rig, const Hands* hands, const BodyFrames& frames,
                   std::span<DriverPose> drivers) {
  static const std::array<Quaternionf, kFingerBoneCount> kResting = resting_fingers();
  std::array<Quaternionf, kFingerBoneCount> R_W;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const bool is_danced = hands != nullptr && (hands->presence >> f & 1u) != 0;
    const int above = kFingerBones[f].parent;
    const std::size_t hand =
        f < kFingerBoneCount / 2 ? index_of(Bone::kLeftHand) : index_of(Bone::kRightHand);
    const Quaternionf& parent =
        above < 0 ? frames.R_WB[hand] : R_W[static_cast<std::size_t>(above)];
    R_W[f] = parent * (is_danced ? hands->R_PB[f] : kResting[f]);
    const std::size_t driver = kFirstFingerDriver + f, leader = rig.finger_leaders[f];
    drivers[driver] = following(rig, driver, leader, drivers[leader]);
    drivers[driver].D = (R_W[f] * rig.C_finger[f]).normalized();
  }
}

void drive_twists(const AvatarRig& rig, std::span<DriverPose> drivers) {
  const AvatarShape& shape = *rig.shape;
  for (const TwistNode& node : shape.twists) {
    const std::size_t bone = index_of(node.bone);
    const bool is_upper = node.bone == Bone::kLeftUpperArm || node.bone == Bone::kRightUpperArm ||
                          node.bone == Bone::kLeftUpperLeg || node.bone == Bone::kRightUpperLeg;
    const auto next = static_cast<Bone>(bone + 1);
    const Vector3f axis = direction(shape, node.bone, next);
    const float share = static_cast<float>(node.step) / static_cast<float>(node.steps);
    float twist = 0.0f;
    if (is_upper) {  // near the trunk less twisted than the bone
      int above = kBones[bone].parent;
      while (above > 0 && !shape.has_bone[static_cast<std::size_t>(above)])
        above = kBones[static_cast<std::size_t>(above)].parent;
      const Quaternionf& trunk = drivers[static_cast<std::size_t>(above)].D;
      twist = (share - 1.0f) * twist_rad(trunk.conjugate() * drivers[bone].D, axis);
    } else {  // near the end as twisted as what follows
      twist = share * twist_rad(drivers[bone].D.conjugate() * drivers[bone + 1].D, axis);
    }
    drivers[node.driver] = following(rig, node.driver, bone, drivers[bone]);
    drivers[node.driver].D = (drivers[bone].D * about(axis, twist)).normalized();
  }
}

void drive_eyes(const AvatarRig& rig, const std::array<float, 2>& gaze_rad,
                std::span<DriverPose> drivers) {
  const Quaternionf turned =
      about(Vector3f::UnitY(), gaze_rad[0]) * about(Vector3f::UnitX(), -gaze_rad[1]);
  for (const int eye : rig.shape->eyes) {
    if (eye < 0) continue;
    const auto driver = static_cast<std::size_t>(eye);
    const std::size_t leader = rig.shape->leaders[driver - kFirstFreeDriver];
    drivers[driver] = following(rig, driver, leader, drivers[leader]);
    drivers[driver].D = (drivers[leader].D * turned).normalized();
  }
}

}  // namespace dance
