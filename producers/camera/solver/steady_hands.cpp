#include "producers/camera/solver/steady_hands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose/shortest_turn.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// `dance capture solve eval --shown` tuned these.
constexpr float kStillCutoff_hz = 0.4f, kCutoffPerSpeed_hz = 12.0f, kSpeedCutoff_hz = 1.5f;
// A speed that a still hand seems to have.
constexpr float kNoSpeed_m_s = 0.06f;
// Along the view, of the arm's length: errors of a speed and of a place.
constexpr float kAlongSpeed = 0.25f, kAlongSd_m = 0.06f;
// From so many standard deviations on the filter opens, and is open.
constexpr float kOpens = 2.0f, kIsOpen = 4.0f;
constexpr float kHardlyVisible = 0.2f;

float share_of(float cutoff_hz, float seconds) {
  return 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * cutoff_hz * seconds);
}

Quaternionf turned(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R;
}

// Two-bone IK that keeps the twist of both bones; the elbow comes as near to `elbow` as it can.
void reach_wrist(const Skeleton& skeleton, const Limb& arm, const Vector3f& wrist_W_m,
                 const Vector3f& elbow_W_m, const Quaternionf& R_WHand, const BodyFrames& frames,
                 Pose& pose) {
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    end = index_of(arm.end);
  const float a = skeleton.offset_m[lower].norm(), b = skeleton.offset_m[end].norm();
  const Vector3f shoulder = frames.p_WB_m[upper];
  Vector3f along = wrist_W_m - shoulder;
  const float wanted = along.norm();
  if (a < 1e-3f || b < 1e-3f || wanted < 1e-3f) return;
  along /= wanted;
  const float distance = std::clamp(wanted, std::abs(a - b) + 1e-3f, a + b - 1e-4f);
  Vector3f bend = elbow_W_m - shoulder;
  bend -= along * along.dot(bend);
  if (bend.norm() < 1e-4f) bend = frames.R_WB[upper] * -Vector3f::UnitZ();
  bend -= along * along.dot(bend);
  if (bend.norm() < 1e-4f) bend = along.unitOrthogonal();
  bend.normalize();
  const float x = (a * a - b * b + distance * distance) / (2.0f * distance);
  const Vector3f elbow =
      shoulder + x * along + std::sqrt(std::max(0.0f, a * a - x * x)) * bend;
  const Vector3f wrist = shoulder + distance * along;
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  const Quaternionf R_WU =
      turned(frames.p_WB_m[lower] - shoulder, elbow - shoulder, frames.R_WB[upper]);
  const Quaternionf R_WL = turned(frames.p_WB_m[end] - frames.p_WB_m[lower], wrist - elbow,
                                  frames.R_WB[lower]);
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
      hand = {wrist.allFinite(), wrist, elbow, R_WHand, wrist, Vector3f::Zero()};
      continue;
    }
    const Vector3f view = (wrist - measurement.eye_W_m).normalized();
    const auto apart = [&view](const Vector3f& v) {
      const float along = v.dot(view);
      return std::pair{(v - along * view).norm(), std::abs(along)};
    };
    hand.velocity_W_m_s += ((wrist - hand.given_W_m) / step - hand.velocity_W_m_s) *
                           share_of(kSpeedCutoff_hz, step);
    hand.given_W_m = wrist;
    const auto [speed_across, speed_along] = apart(hand.velocity_W_m_s);
    const float speed = std::hypot(speed_across, kAlongSpeed * speed_along);
    const float less = std::max(kHardlyVisible, measurement.visibility[s]);
    const auto [off_across, off_along] = apart(wrist - hand.shown_W_m);
    const float off =
        less * std::hypot(off_across / measurement.across_sd_m, off_along / kAlongSd_m);
    const float open = std::clamp((off - kOpens) / (kIsOpen - kOpens), 0.0f, 1.0f);
    const float cutoff_hz =
        kStillCutoff_hz + kCutoffPerSpeed_hz * less * std::max(0.0f, speed - kNoSpeed_m_s);
    const float share = std::max(share_of(cutoff_hz, step), open);
    hand.shown_W_m += share * (wrist - hand.shown_W_m);
    hand.elbow_W_m += share * (elbow - hand.elbow_W_m);
    hand.R_WHand = hand.R_WHand.slerp(share, R_WHand).normalized();
    if (share >= 1.0f) continue;
    reach_wrist(skeleton, arm, hand.shown_W_m, hand.elbow_W_m, hand.R_WHand, frames, pose);
  }
}

}  // namespace dance
