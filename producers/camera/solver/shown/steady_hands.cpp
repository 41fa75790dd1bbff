#include "producers/camera/solver/shown/steady_hands.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/pose/shortest_turn.h"
#include "producers/camera/solver/shown/facing.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// `dance capture solve eval --shown` tuned these.
constexpr float kStillCutoff_hz = 0.12f, kCutoffPerSpeed_hz = 60.0f, kSpeedCutoff_hz = 1.5f;
// A speed that a still hand seems to have.
constexpr float kNoSpeed_m_s = 0.1f;
// What a speed along the view counts at least.
constexpr float kAlongSpeed = 0.1f;
// From so many standard deviations on the filter opens, and is open; by how much in a time of
// so long.
constexpr float kOpens = 3.5f, kIsOpen = 7.0f, kOpensIn_s = 1.0f / 30.0f;
// The trunk's place and turn, as the wrists'.
constexpr float kTrunkCutoff_hz = 0.05f, kTrunkPerSpeed_hz = 20.0f, kTrunkNoSpeed_m_s = 0.5f;
constexpr float kTrunkOpens_m = 0.08f, kTrunkIsOpen_m = 0.2f;
constexpr float kTurnCutoff_hz = 0.05f, kTurnPerSpeed_hz = 6.0f, kNoTurn_rad_s = 1.5f;
constexpr float kTurnOpens_rad = 0.3f, kTurnIsOpen_rad = 0.7f;
// A hand that was still stays beside the trunk while it is hidden, but not for longer; then, and
// when it is seen elsewhere, it goes there within a moment.
constexpr float kHidden = 0.1f, kStill_m_s = 0.08f, kMostHeld_s = 1.0f;
constexpr float kOutOfReach_m = 0.1f;
constexpr Duration kLetGo = Duration::ms(120);
// It is back when its arm has been seen for so long; longer where it seems elsewhere and is hardly
// seen.
constexpr float kBack_s = 0.1f, kSettles_s = 0.3f, kWellSeen = 0.5f, kMovedAway_s = 0.8f;
constexpr float kStraightest = 0.998f;

float share_of(float cutoff_hz, float seconds) {
  return 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * cutoff_hz * seconds);
}

// The share of a filter that opens between two distances, at any rate of pictures.
float opened(float off, float opens, float is_open, float seconds) {
  const float open = std::clamp((off - opens) / (is_open - opens), 0.0f, 1.0f);
  return 1.0f - std::pow(1.0f - open * open, seconds / kOpensIn_s);
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

void SteadyHands::Arm::approach(const Arm& other, float share) {
  wrist_B_m += share * (other.wrist_B_m - wrist_B_m);
  elbow_B_m += share * (other.elbow_B_m - elbow_B_m);
  R_BHand = R_BHand.slerp(share, other.R_BHand).normalized();
}

void SteadyHands::follow_trunk(const BodyFrames& frames, float step) {
  const Vector3f left = frames.position(kLeftArm.upper), right = frames.position(kRightArm.upper);
  const Vector3f hips = frames.position(Bone::kHips);
  const std::optional<double> facing =
      facing_of((frames.position(kLeftLeg.upper) - frames.position(kRightLeg.upper)).cast<double>(),
                (left - right).cast<double>());
  Trunk& t = trunk_;
  const float yaw = facing ? static_cast<float>(*facing) : t.given_yaw_rad;
  const auto between = [](float from, float to) {
    return std::remainder(to - from, 2.0f * std::numbers::pi_v<float>);
  };
  if (!t.is_known) {
    t = Trunk();
    t.is_known = true;
    t.p_WB_m = t.given_W_m = hips;
    t.yaw_rad = t.given_yaw_rad = yaw;
  }
  const float speed_share = share_of(kSpeedCutoff_hz, step);
  t.velocity_W_m_s += speed_share * ((hips - t.given_W_m) / step - t.velocity_W_m_s);
  t.yaw_speed_rad_s += speed_share * (between(t.given_yaw_rad, yaw) / step - t.yaw_speed_rad_s);
  t.given_W_m = hips;
  t.given_yaw_rad = yaw;
  const float cutoff_hz =
      kTrunkCutoff_hz +
      kTrunkPerSpeed_hz * std::max(0.0f, t.velocity_W_m_s.norm() - kTrunkNoSpeed_m_s);
  const Vector3f off = hips - t.p_WB_m;
  t.p_WB_m +=
      std::max(share_of(cutoff_hz, step), opened(off.norm(), kTrunkOpens_m, kTrunkIsOpen_m, step)) *
      off;
  const float turn_hz =
      kTurnCutoff_hz +
      kTurnPerSpeed_hz * std::max(0.0f, std::abs(t.yaw_speed_rad_s) - kNoTurn_rad_s);
  const float turn = between(t.yaw_rad, yaw);
  t.yaw_rad += std::max(share_of(turn_hz, step),
                        opened(std::abs(turn), kTurnOpens_rad, kTurnIsOpen_rad, step)) *
               turn;
  t.yaw_rad = between(0.0f, t.yaw_rad);
  t.R_WB = Eigen::AngleAxisf(t.yaw_rad, Vector3f::UnitY());
}

bool SteadyHands::hold(Hand& hand, const Arm& given, float seen, float off, bool is_still,
                       bool reaches, float step) {
  const bool is_hidden = seen < kHidden;
  if (is_hidden && !hand.is_lost) {
    hand.is_lost = true;
    hand.is_held = is_still;
    hand.hidden_s = hand.seen_for_s = 0.0f;
  }
  if (!hand.is_lost) return false;
  if (is_hidden) hand.hidden_s += step;
  hand.seen_for_s = std::max(0.0f, hand.seen_for_s + (is_hidden ? -step : step));
  const bool is_away = hand.is_held && off > kOpens;
  if (!is_hidden &&
      hand.seen_for_s >= (is_away ? (seen < kWellSeen ? kMovedAway_s : kSettles_s) : kBack_s))
    hand.is_lost = false;
  if (!hand.is_held) return false;
  if (hand.is_lost && hand.hidden_s < kMostHeld_s && reaches) return true;
  hand.is_held = false;
  if (!is_away) return false;
  hand.held = hand.shown;
  hand.shown = given;
  hand.blend = Spring();
  hand.blend.offset.x() = 1.0f;
  return false;
}

void SteadyHands::apply(const Skeleton& skeleton, const Measurement& measurement, double seconds,
                        Pose& pose) {
  const auto step = static_cast<float>(std::clamp(seconds, 1e-3, 0.5));
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  if (!frames.position(kLeftArm.end).allFinite() || !frames.position(kRightArm.end).allFinite()) {
    clear();
    return;
  }
  follow_trunk(frames, step);
  const Vector3f eye_B_m = trunk_.to_B(measurement.eye_W_m);
  for (std::size_t s = 0; s < 2; ++s) {
    Hand& hand = hands_[s];
    const Limb& limb = s == 0 ? kLeftArm : kRightArm;
    const Arm given{trunk_.to_B(frames.position(limb.end)),
                    trunk_.to_B(frames.position(limb.lower)),
                    trunk_.R_WB.conjugate() * frames.R_WB[index_of(limb.end)]};
    const Vector3f& wrist = given.wrist_B_m;
    if (!std::exchange(hand.is_known, true)) {
      hand.shown = given;
      hand.given_B_m = wrist;
      continue;
    }
    const Vector3f view = (wrist - eye_B_m).normalized();
    const auto apart = [&view](const Vector3f& v) {
      const float along = v.dot(view);
      return std::pair{(v - along * view).norm(), std::abs(along)};
    };
    const float along_sd_m = measurement.along_sd_m[s];
    // A second camera measures the way along the view as well as the other ways.
    const float along_speed =
        along_sd_m < kOneEyeAlongSd_m
            ? std::max(kAlongSpeed, std::min(1.0f, measurement.across_sd_m / along_sd_m))
            : kAlongSpeed;
    const auto speed_of = [&apart, along_speed](const Hand& of) {
      const auto [across, along] = apart(of.velocity_B_m_s);
      return std::hypot(across, along_speed * along);
    };
    const auto [off_across, off_along] = apart(wrist - hand.shown.wrist_B_m);
    const float off = std::hypot(off_across / measurement.across_sd_m, off_along / along_sd_m);
    const float longest =
        kOutOfReach_m + skeleton.offset(limb.lower).norm() + skeleton.offset(limb.end).norm();
    const bool reaches =
        (hand.shown.wrist_B_m - trunk_.to_B(frames.position(limb.upper))).norm() <= longest;
    const bool is_held = hold(hand, given, std::clamp(measurement.visibility[s], 0.0f, 1.0f), off,
                              speed_of(hand) < kStill_m_s, reaches, step);
    if (!hand.is_lost)
      hand.velocity_B_m_s +=
          ((wrist - hand.given_B_m) / step - hand.velocity_B_m_s) * share_of(kSpeedCutoff_hz, step);
    hand.given_B_m = wrist;
    float share = 0.0f;
    if (hand.is_lost) {
      share = is_held ? 0.0f : 1.0f;
    } else {
      const float cutoff_hz =
          kStillCutoff_hz + kCutoffPerSpeed_hz * std::max(0.0f, speed_of(hand) - kNoSpeed_m_s);
      share = std::max(share_of(cutoff_hz, step), opened(off, kOpens, kIsOpen, step));
    }
    hand.shown.approach(given, share);
    Arm shown = hand.shown;
    hand.blend.advance(Spring::y_of_half_life(kLetGo), step);
    const bool is_blended = !hand.blend.is_at_rest();
    if (is_blended) shown.approach(hand.held, std::clamp(hand.blend.offset.x(), 0.0f, 1.0f));
    if (share >= 1.0f && !is_blended) continue;
    reach_wrist(skeleton, limb, trunk_.to_W(shown.wrist_B_m), trunk_.to_W(shown.elbow_B_m),
                trunk_.R_WB * shown.R_BHand, frames, pose);
  }
}

}  // namespace dance
