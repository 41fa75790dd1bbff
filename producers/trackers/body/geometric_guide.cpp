#include "producers/trackers/body/geometric_guide.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kYaw_s = 0.15f, kHipsSpeed_s = 0.15f;
// How much hands turn the trunk, where they are far enough apart to say so; furthest from the head.
constexpr float kHandsTurn = 0.35f, kHandsApart_m = 0.25f, kMostNeck_rad = 1.1f;
constexpr float kFeetTurn = 0.3f;
// Of the head's bow: the trunk's share; each bone of the trunk has its part of it.
constexpr float kLeanOfBow = 0.3f, kMostLean_rad = 0.8f;
constexpr float kHipsLean = 0.4f;
// A step: begins so far from the rest, takes so long, rises so high.
constexpr float kStepBeyond_m = 0.16f, kStepBeyond_rad = 0.6f, kFarBeyond_m = 0.35f;
constexpr float kStep_s = 0.26f, kStepUp_m = 0.07f, kStepLead_s = 0.3f, kLeastStance_s = 0.08f;
constexpr float kHangs_rad = 1.25f;
constexpr float kJumped_m = 1.5f;

float wrapped(float angle_rad) { return std::remainder(angle_rad, 2.0f * kPi); }

Quaternionf bowed(float angle_rad) {
  return Quaternionf(Eigen::AngleAxisf(angle_rad, Vector3f::UnitX()));
}

float ankle_rest_m(const Skeleton& skeleton) {
  return skeleton.hips_height_m() + skeleton.offset(Bone::kLeftUpperLeg).y() +
         skeleton.offset(Bone::kLeftLowerLeg).y() + skeleton.offset(Bone::kLeftFoot).y();
}

}  // namespace

float GeometricGuide::wanted_yaw_rad(const BonePlaces& bones) const {
  if (bones.has(TrackedPoint::kHips)) return heading_rad(bones.of(TrackedPoint::kHips).R_W);
  if (bones.has(TrackedPoint::kChest)) return heading_rad(bones.of(TrackedPoint::kChest).R_W);
  const float head = heading_rad(bones.of(TrackedPoint::kHead).R_W);
  float yaw = head;
  if (bones.has(TrackedPoint::kLeftHand) && bones.has(TrackedPoint::kRightHand)) {
    Vector3f span =
        bones.of(TrackedPoint::kLeftHand).p_W_m - bones.of(TrackedPoint::kRightHand).p_W_m;
    span.y() = 0.0f;
    const Vector3f ahead = span.cross(Vector3f::UnitY());
    const float turn = wrapped(std::atan2(ahead.x(), ahead.z()) - head);
    // Hands that are crossed, or close together, say nothing.
    const float trust = std::clamp(span.norm() / kHandsApart_m - 1.0f, 0.0f, 1.0f) *
                        std::clamp(2.0f - 1.5f * std::abs(turn), 0.0f, 1.0f);
    yaw += kHandsTurn * trust * turn;
  }
  if (bones.has(TrackedPoint::kLeftFoot) && bones.has(TrackedPoint::kRightFoot)) {
    const float left = heading_rad(bones.of(TrackedPoint::kLeftFoot).R_W);
    const float right = heading_rad(bones.of(TrackedPoint::kRightFoot).R_W);
    yaw += kFeetTurn * wrapped(left + 0.5f * wrapped(right - left) - yaw);
  }
  return head + std::clamp(wrapped(yaw - head), -kMostNeck_rad, kMostNeck_rad);
}

void GeometricGuide::guess_trunk(const Skeleton& skeleton, const BonePlaces& bones,
                                 BodyGuess& guess) const {
  const Place& head = bones.of(TrackedPoint::kHead);
  const Vector3f looks = head.R_W * Vector3f::UnitZ();
  const float bow = std::asin(std::clamp(-looks.y(), -1.0f, 1.0f));
  const float lean = std::clamp(kLeanOfBow * bow, -0.2f, kMostLean_rad);
  const Quaternionf facing = about_up(yaw_rad_);
  Quaternionf R_WHips = facing * bowed(kHipsLean * lean);
  if (bones.has(TrackedPoint::kHips)) R_WHips = bones.of(TrackedPoint::kHips).R_W;
  Quaternionf R_WTop =
      facing * about_up(0.25f * wrapped(heading_rad(head.R_W) - yaw_rad_)) * bowed(lean);
  if (bones.has(TrackedPoint::kChest)) R_WTop = bones.of(TrackedPoint::kChest).R_W;
  guess.R(Bone::kHips) = R_WHips;
  guess.R(Bone::kSpine) = R_WHips.slerp(0.35f, R_WTop);
  guess.R(Bone::kChest) = R_WHips.slerp(0.7f, R_WTop);
  for (const Bone bone : {Bone::kUpperChest, Bone::kLeftShoulder, Bone::kRightShoulder})
    guess.R(bone) = R_WTop;
  guess.R(Bone::kNeck) = R_WTop.slerp(0.5f, head.R_W);
  guess.R(Bone::kHead) = head.R_W;
  // From the head down, so that the head is where it is.
  Vector3f p = head.p_W_m;
  for (const Bone bone :
       {Bone::kHead, Bone::kNeck, Bone::kUpperChest, Bone::kChest, Bone::kSpine}) {
    const auto parent = static_cast<std::size_t>(kBones[index_of(bone)].parent);
    p -= guess.R_WB[parent] * skeleton.offset(bone);
  }
  guess.p_WH_m = bones.has(TrackedPoint::kHips) ? bones.of(TrackedPoint::kHips).p_W_m : p;
}

void GeometricGuide::guess_arm(const Skeleton& skeleton, const BonePlaces& bones, bool left,
                               const Pose& pose, BodyFrames& frames, BodyGuess& guess) const {
  const Limb& arm = left ? kLeftArm : kRightArm;
  const float side = left ? 1.0f : -1.0f;
  const TrackedPoint hand = left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand;
  const Quaternionf& R_WTop = guess.R(Bone::kUpperChest);
  if (!bones.has(hand)) {
    const Eigen::AngleAxisf down(-side * kHangs_rad, Vector3f::UnitZ());
    const Quaternionf R = R_WTop * bowed(-0.15f) * Quaternionf(down);
    guess.R(arm.upper) = guess.R(arm.lower) = guess.R(arm.end) = R;
    return;
  }
  const Place& place = bones.of(hand);
  const Vector3f shoulder = frames.position(arm.upper);
  // Down, out and behind; and where the forearm would continue the hand.
  const Vector3f usual = R_WTop * Vector3f(0.35f * side, -0.8f, -0.5f);
  const Vector3f from_hand = place.p_W_m - place.R_W * skeleton.offset(arm.end);
  const Vector3f middle = 0.5f * (shoulder + place.p_W_m);
  const Vector3f pole = 0.12f * usual + 0.6f * (from_hand - middle);
  Pose with_arm = pose;
  solve_two_bone(skeleton, arm, place.p_W_m, pole, place.R_W, with_arm, frames);
  guess.R(arm.upper) = frames.R_WB[index_of(arm.upper)];
  guess.R(arm.lower) = frames.R_WB[index_of(arm.lower)];
  guess.R(arm.end) = place.R_W;
}

Vector3f GeometricGuide::rest_place(const Skeleton& skeleton, const BodyGuess& guess,
                                    bool left) const {
  const Bone upper = left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
  const float side = left ? 1.0f : -1.0f;
  const float width = std::abs(skeleton.offset(upper).x());
  Vector3f rest = guess.p_WH_m + about_up(yaw_rad_) * Vector3f(1.05f * side * width, 0.0f, -0.02f);
  rest.y() = ankle_rest_m(skeleton);
  return rest;
}

void GeometricGuide::swing(Foot& foot, const Vector3f& to, float seconds) const {
  foot.step_s += seconds;
  const float part = std::min(1.0f, foot.step_s / kStep_s);
  const float eased = part * part * (3.0f - 2.0f * part);
  foot.ankle = foot.from + eased * (to - foot.from);
  foot.ankle.y() = to.y() + kStepUp_m * std::sin(kPi * part);
  foot.yaw_rad = foot.from_yaw_rad + eased * wrapped(yaw_rad_ - foot.from_yaw_rad);
  if (part < 1.0f) return;
  foot.step_s = -1.0f;
  foot.stood_s = 0.0f;
}

void GeometricGuide::step_feet(const Skeleton& skeleton, const BonePlaces& bones,
                               const BodyGuess& guess, float seconds) {
  const std::array<Vector3f, 2> rest{rest_place(skeleton, guess, true),
                                     rest_place(skeleton, guess, false)};
  std::array<float, 2> urge{};
  for (std::size_t side = 0; side < 2; ++side) {
    Foot& foot = feet_[side];
    const TrackedPoint point = side == 0 ? TrackedPoint::kLeftFoot : TrackedPoint::kRightFoot;
    if (bones.has(point)) {
      foot = Foot();
      foot.ankle = bones.of(point).p_W_m;
      foot.yaw_rad = heading_rad(bones.of(point).R_W);
      continue;
    }
    Vector3f apart = rest[side] - foot.ankle;
    apart.y() = 0.0f;
    if (!began_ || apart.norm() > kJumped_m) {
      foot = Foot();
      foot.ankle = rest[side];
      foot.yaw_rad = yaw_rad_;
      continue;
    }
    if (foot.step_s >= 0.0f) {
      const Vector3f lead = hips_m_s_ * (kStepLead_s + std::max(0.0f, kStep_s - foot.step_s));
      const float most = std::min(1.0f, 0.35f / std::max(lead.norm(), 1e-3f));
      swing(foot, rest[side] + most * lead, seconds);
      continue;
    }
    foot.stood_s += seconds;
    foot.ankle.y() = rest[side].y();
    urge[side] = std::max(apart.norm() / kStepBeyond_m,
                          std::abs(wrapped(yaw_rad_ - foot.yaw_rad)) / kStepBeyond_rad);
  }
  const std::size_t next = urge[0] >= urge[1] ? 0 : 1;
  Foot& foot = feet_[next];
  const bool other_stands =
      feet_[1 - next].step_s < 0.0f && feet_[1 - next].stood_s > kLeastStance_s;
  const bool is_far = urge[next] * kStepBeyond_m > kFarBeyond_m;
  if (urge[next] > 1.0f && (other_stands || is_far)) {
    foot.from = foot.ankle;
    foot.from_yaw_rad = foot.yaw_rad;
    foot.step_s = 0.0f;
  }
}

void GeometricGuide::guess_legs(const Skeleton& skeleton, Pose& pose, BodyFrames& frames,
                                BodyGuess& guess) const {
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
    const Foot& foot = feet_[side];
    const Quaternionf R_WFoot = about_up(foot.yaw_rad + (side == 0 ? 0.12f : -0.12f));
    guess.ankles_W_m[side] = foot.ankle;
    guess.stands[side] = foot.step_s < 0.0f ? 1.0f : 0.0f;
    // Knees point between the hips' front and the foot's.
    const Vector3f pole = guess.R(Bone::kHips) * Vector3f::UnitZ() + R_WFoot * Vector3f::UnitZ();
    solve_two_bone(skeleton, leg, foot.ankle, pole, R_WFoot, pose, frames);
    guess.R(leg.upper) = frames.R_WB[index_of(leg.upper)];
    guess.R(leg.lower) = frames.R_WB[index_of(leg.lower)];
    guess.R(leg.end) = R_WFoot;
    guess.R(side == 0 ? Bone::kLeftToes : Bone::kRightToes) = R_WFoot;
  }
}

void GeometricGuide::guess(const Skeleton& skeleton, const BonePlaces& bones, float seconds,
                           BodyGuess& guess) {
  const float wanted = wanted_yaw_rad(bones);
  yaw_rad_ = began_ ? yaw_rad_ + (1.0f - std::exp(-seconds / kYaw_s)) * wrapped(wanted - yaw_rad_)
                    : wanted;
  guess_trunk(skeleton, bones, guess);
  if (began_ && seconds > 0.0f) {
    Vector3f speed = (guess.p_WH_m - hips_before_) / seconds;
    speed.y() = 0.0f;
    hips_m_s_ += (1.0f - std::exp(-seconds / kHipsSpeed_s)) * (speed - hips_m_s_);
  }
  hips_before_ = guess.p_WH_m;
  step_feet(skeleton, bones, guess, seconds);
  began_ = true;
  // Frames of the trunk, for the limbs to begin from.
  Pose pose;
  BodyFrames frames;
  pose.p_WH_m = guess.p_WH_m;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const std::int8_t parent = kBones[b].parent;
    pose.R_PB[b] = parent < 0
                       ? guess.R_WB[b]
                       : guess.R_WB[static_cast<std::size_t>(parent)].conjugate() * guess.R_WB[b];
  }
  forward_kinematics(skeleton, pose, frames);
  guess_arm(skeleton, bones, true, pose, frames, guess);
  guess_arm(skeleton, bones, false, pose, frames, guess);
  guess_legs(skeleton, pose, frames, guess);
}

}  // namespace dance
