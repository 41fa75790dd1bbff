#include "producers/camera/solver/shown/steady_hands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose/shortest_turn.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// `dance capture solve eval --shown` tuned these.
constexpr float kStillCutoff_hz = 0.12f, kCutoffPerSpeed_hz = 60.0f, kSpeedCutoff_hz = 1.5f;
// A speed that a still hand seems to have.
constexpr float kNoSpeed_m_s = 0.1f;
// Along the view: what a speed counts, and the errors of a place.
constexpr float kAlongSpeed = 0.1f, kAlongSd_m = 0.09f;
// From so many standard deviations on the filter opens, and is open.
constexpr float kOpens = 3.5f, kIsOpen = 7.0f;
// A hand that was still stays where it was seen while it is hidden, and until its arm is back.
constexpr float kHidden = 0.1f, kStill_m_s = 0.08f, kBack_s = 0.1f, kMovedAway_s = 0.8f;
constexpr float kStraightest = 0.998f;

float share_of(float cutoff_hz, float seconds) {
  return 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * cutoff_hz * seconds);
}

Quaternionf turned(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R;
}

// The part of `v` across `along`, of length 1; across `instead` where there is hardly any.
Vector3f across(const Vector3f& along, const Vector3f& v, const Vector3f& instead) {
  Vector3f side = v - along * along.dot(v);
  if (side.norm() < 1e-3f) side = instead - along * along.dot(instead);
  if (side.norm() < 1e-3f) side = along.unitOrthogonal();
  return side.normalized();
}

Eigen::Matrix3f axes(const Vector3f& along, const Vector3f& side) {
  Eigen::Matrix3f R;
  R.col(0) = along;
  R.col(1) = side;
  R.col(2) = along.cross(side);
  return R;
}

// Two-bone IK: the arm's plane is turned as a whole, then the elbow bends within it, about the
// hinge that it has. The elbow comes as near to `elbow_W_m` as that allows.
void reach_wrist(const Skeleton& skeleton, const Limb& arm, const Vector3f& wrist_W_m,
                 const Vector3f& elbow_W_m, const Quaternionf& R_WHand, const BodyFrames& frames,
                 Pose& pose) {
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    end = index_of(arm.end);
  const float a = skeleton.offset_m[lower].norm(), b = skeleton.offset_m[end].norm();
  const Vector3f shoulder = frames.p_WB_m[upper];
  const Vector3f was = frames.p_WB_m[end] - shoulder, to = wrist_W_m - shoulder;
  if (a < 1e-3f || b < 1e-3f || was.norm() < 1e-3f || to.norm() < 1e-3f) return;
  const float longest = std::max(was.norm(), kStraightest * (a + b));
  const float distance = std::clamp(to.norm(), std::abs(a - b) + 1e-3f, longest);
  const Vector3f along_was = was.normalized(), along = to.normalized();
  // An arm that is straight bends backwards.
  const Vector3f back = frames.R_WB[upper] * -Vector3f::UnitZ();
  const Vector3f side_was = across(along_was, frames.p_WB_m[lower] - shoulder, back);
  const Quaternionf swing =
      shortest_turn(along_was.cast<double>(), along.cast<double>()).cast<float>();
  const Vector3f side = across(along, elbow_W_m - shoulder, swing * side_was);
  const Quaternionf turn(
      Eigen::Matrix3f(axes(along, side) * axes(along_was, side_was).transpose()));
  const float x = (a * a - b * b + distance * distance) / (2.0f * distance);
  const Vector3f elbow = x * along + std::sqrt(std::max(0.0f, a * a - x * x)) * side;
  const Vector3f wrist = distance * along;
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  const Quaternionf R_WU =
      turned(turn * (frames.p_WB_m[lower] - shoulder), elbow, turn * frames.R_WB[upper]);
  const Quaternionf R_WL = turned(turn * (frames.p_WB_m[end] - frames.p_WB_m[lower]), wrist - elbow,
                                  turn * frames.R_WB[lower]);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * R_WU).normalized();
  pose.R_PB[lower] = (R_WU.conjugate() * R_WL).normalized();
  pose.R_PB[end] = (R_WL.conjugate() * R_WHand).normalized();
}

}  // namespace

void SteadyHands::apply(const Skeleton& skeleton, const Measurement& measurement, double seconds,
                        Pose& pose) {
  const auto step = static_cast<float>(std::clamp(seconds, 1e-3, 0.5));
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  for (std::size_t s = 0; s < 2; ++s) {
    Hand& hand = hands_[s];
    const Limb& arm = s == 0 ? kLeftArm : kRightArm;
    const Vector3f wrist = frames.position(arm.end), elbow = frames.position(arm.lower);
    const Quaternionf& R_WHand = frames.R_WB[index_of(arm.end)];
    if (!hand.is_known || !wrist.allFinite()) {
      hand = Hand();
      hand.is_known = wrist.allFinite();
      hand.shown_W_m = hand.given_W_m = wrist;
      hand.elbow_W_m = elbow;
      hand.R_WHand = R_WHand;
      continue;
    }
    const Vector3f view = (wrist - measurement.eye_W_m).normalized();
    const auto apart = [&view](const Vector3f& v) {
      const float along = v.dot(view);
      return std::pair{(v - along * view).norm(), std::abs(along)};
    };
    const float seen = std::clamp(measurement.visibility[s], 0.0f, 1.0f);
    const auto [was_across, was_along] = apart(hand.velocity_W_m_s);
    if (seen < kHidden) {
      if (hand.seen_for_s > 0.0f)
        hand.is_held = std::hypot(was_across, kAlongSpeed * was_along) < kStill_m_s;
      hand.seen_for_s = 0.0f;
    } else {
      hand.seen_for_s += step;
    }
    const auto [off_across, off_along] = apart(wrist - hand.shown_W_m);
    const float off = std::hypot(off_across / measurement.across_sd_m, off_along / kAlongSd_m);
    const bool is_back = hand.seen_for_s >= (hand.is_held && off > kOpens ? kMovedAway_s : kBack_s);
    if (is_back)
      hand.velocity_W_m_s +=
          ((wrist - hand.given_W_m) / step - hand.velocity_W_m_s) * share_of(kSpeedCutoff_hz, step);
    hand.given_W_m = wrist;
    const auto [speed_across, speed_along] = apart(hand.velocity_W_m_s);
    const float speed = std::hypot(speed_across, kAlongSpeed * speed_along);
    const float open = std::clamp((off - kOpens) / (kIsOpen - kOpens), 0.0f, 1.0f);
    const float cutoff_hz =
        kStillCutoff_hz + kCutoffPerSpeed_hz * std::max(0.0f, speed - kNoSpeed_m_s);
    float share = std::max(share_of(cutoff_hz, step), open * open);
    if (!is_back) share = hand.is_held ? seen * share_of(kStillCutoff_hz, step) : 1.0f;
    hand.shown_W_m += share * (wrist - hand.shown_W_m);
    hand.elbow_W_m += share * (elbow - hand.elbow_W_m);
    hand.R_WHand = hand.R_WHand.slerp(share, R_WHand).normalized();
    if (share >= 1.0f) continue;
    reach_wrist(skeleton, arm, hand.shown_W_m, hand.elbow_W_m, hand.R_WHand, frames, pose);
  }
}

}  // namespace dance
