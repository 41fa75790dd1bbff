#include "core/motion/foot_lock.h"

#include <algorithm>
#include <cmath>

#include "core/motion/standing_odds.h"
#include "core/pose/shortest_turn.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr std::array<Limb, 2> kLegs{kLeftLeg, kRightLeg};
constexpr std::array<Bone, 2> kBalls{Bone::kLeftToes, Bone::kRightToes};
// A longer gap is not a step of the same dance.
constexpr Duration kLongestStep = Duration::ms(250);
// Faster than any foot: the dancer jumped elsewhere.
constexpr float kFastestBall_m_s = 25.0f;
// The estimate falls quickly and rises slowly, so that jumps do not lift it; outliers of a few
// frames hardly move it. A foot far above it for long was never on it.
constexpr float kFloorFalls_m_s = 0.3f;
constexpr float kFloorRises_m_s = 0.02f;
constexpr float kFloorRises_1_s = 0.3f;
constexpr float kFarAbove_m = 0.08f;
constexpr float kElsewhere_m = 0.5f;
// Speeds are averaged over this time, so that sensor noise does not lift a foot.
constexpr float kSpeedOver_s = 0.04f;
constexpr float kGlide_s = 0.015f;
constexpr float kSeenSpeedOver_s = 0.02f;
constexpr float kStandsBelow_m_s = 0.2f;
constexpr float kToSeen_s = 0.3f;
constexpr float kNothing_m = 1e-5f;
constexpr float kLongest_s = 10.0f;
constexpr float kStraight = 0.9995f;

Quaternionf turned(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return (shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R).normalized();
}

}  // namespace

FootLock::FootLock() : FootLock(Settings()) {}

FootLock::FootLock(const Settings& settings) : settings_(settings), skeleton_(average_skeleton()) {}

void FootLock::set_body(const Skeleton& skeleton) {
  if (is_valid(skeleton)) skeleton_ = skeleton;
}

void FootLock::clear() {
  feet_ = {};
  began_ = false;
  is_foreseen_ = false;
  hold_odds_.clear();
  seen_at_ = MonoTime();
}

void FootLock::follow_floor(float low_m, float seconds) {
  const float above_m = low_m - floor_m_;
  const float rise_m_s = kFloorRises_m_s + kFloorRises_1_s * std::max(0.0f, above_m - kFarAbove_m);
  floor_m_ += std::clamp(above_m, -kFloorFalls_m_s * seconds, rise_m_s * seconds);
}

void FootLock::observe(const Pose& real, MonoTime now) {
  BodyFrames frames;
  forward_kinematics(skeleton_, real, frames);
  const Duration step = real.capture_time - seen_capture_;
  const auto seconds = static_cast<float>(step.as_seconds());
  const bool is_first = !seen_at_.is_set();
  seen_capture_ = real.capture_time;
  seen_at_ = now;
  // What arrived tells the floor; predicted feet may dip below it.
  const float low_m = std::min(frames.position(kBalls[0]).y(), frames.position(kBalls[1]).y());
  if (std::isfinite(low_m)) {
    if (is_first || std::abs(low_m - floor_m_) > kElsewhere_m)
      floor_m_ = low_m;
    else if (step > Duration() && step <= kLongestStep)
      follow_floor(low_m, seconds);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    Foot& foot = feet_[side];
    const Vector3f ball = frames.position(kBalls[side]);
    if (step > Duration() && step <= kLongestStep && ball.allFinite()) {
      const float speed_m_s = (ball - foot.seen).norm() / seconds;
      foot.seen_speed_m_s +=
          (speed_m_s - foot.seen_speed_m_s) * (1.0f - std::exp(-seconds / kSeenSpeedOver_s));
    } else {
      foot.seen_speed_m_s = settings_.release_above_m_s;
    }
    foot.seen = ball;
    const bool was_standing = foot.seen_standing;
    foot.seen_standing =
        foot.seen_speed_m_s < kStandsBelow_m_s && ball.y() - floor_m_ < settings_.release_above_m;
    foot.seen_for_s = foot.seen_standing == was_standing && step <= kLongestStep
                          ? std::min(foot.seen_for_s + std::max(seconds, 0.0f), kLongest_s)
                          : 0.0f;
  }
  seen_hips_ = real.p_WH_m;
  hold_odds_.see(real.capture_time, {feet_[0].seen_standing, feet_[1].seen_standing});
}

void FootLock::foresee(const Pose& before, const Pose& there, const Pose& after, Duration ahead) {
  std::array<BodyFrames, 3> frames;
  forward_kinematics(skeleton_, before, frames[0]);
  forward_kinematics(skeleton_, there, frames[1]);
  forward_kinematics(skeleton_, after, frames[2]);
  is_foreseen_ = began_;
  std::array<FootView, 2> views;
  for (std::size_t side = 0; side < 2; ++side) {
    const Foot& foot = feet_[side];
    const Bone ball = kBalls[side];
    views[side] = {
        frames[0].position(ball), frames[1].position(ball),
        frames[2].position(ball), foot.seen,
        foot.seen_speed_m_s,      foot.seen_standing ? foot.seen_for_s : -foot.seen_for_s};
  }
  const HipsView hips{there.p_WH_m, seen_hips_, static_cast<float>(ahead.as_seconds())};
  for (std::size_t side = 0; side < 2; ++side) {
    feet_[side].odds = standing_log_odds(views[side], views[1 - side], hips, floor_m_);
    if (!std::isfinite(feet_[side].odds)) is_foreseen_ = false;
  }
  if (is_foreseen_) hold_odds_.foresee(there.capture_time, {feet_[0].odds, feet_[1].odds});
  unsure_ = std::clamp(static_cast<float>(ahead.as_seconds() / settings_.unsure_from.as_seconds()),
                       0.0f, 1.0f);
}

bool FootLock::should_hold_foreseen(const Foot& foot) const {
  const Vector3f from = foot.locked ? foot.held : Vector3f(foot.raw + foot.shift.offset);
  const float furthest_m = settings_.sure_furthest_m +
                           unsure_ * (settings_.unsure_furthest_m - settings_.sure_furthest_m);
  const float least = hold_odds_.value() - (foot.locked ? settings_.release_odds_below : 0.0f);
  return foot.odds > least && (from - foot.raw).norm() < furthest_m;
}

bool FootLock::should_hold(const Foot& foot) const {
  if (is_foreseen_) return should_hold_foreseen(foot);
  const bool is_seen = is_fresh();
  if (is_seen && foot.seen_standing)
    return (foot.seen - foot.raw).norm() <
           (foot.locked ? settings_.furthest_m : settings_.lifts_beyond_m);
  const float height_m = foot.raw.y() - floor_m_;
  if (!foot.locked)
    return foot.speed_m_s < (is_seen ? settings_.seen_lock_below_m_s : settings_.lock_below_m_s) &&
           height_m < settings_.lock_below_m;
  return foot.speed_m_s <
             (is_seen ? settings_.seen_release_above_m_s : settings_.release_above_m_s) &&
         height_m < settings_.release_above_m &&
         (foot.held - foot.raw).norm() < settings_.furthest_m;
}

void FootLock::follow(Foot& foot, const Vector3f& raw, float seconds, bool may_lock) {
  const Vector3f velocity = (raw - foot.raw) / seconds;
  foot.speed_m_s += (velocity.norm() - foot.speed_m_s) * (1.0f - std::exp(-seconds / kSpeedOver_s));
  const Vector3f shown_before = foot.raw + foot.shift.offset;
  foot.raw = raw;
  const bool was_locked = foot.locked;
  foot.locked = may_lock && should_hold(foot);
  const Vector3f offset_before = foot.shift.offset;
  if (foot.locked) {
    if (!was_locked) {
      foot.held = shown_before;
      foot.glide = velocity + foot.shift.velocity;
    }
    const float fade = std::exp(-seconds / kGlide_s);
    foot.held += foot.glide * (kGlide_s * (1.0f - fade));
    foot.glide *= fade;
    // Where it really stands, slowly.
    if (!is_foreseen_ && is_fresh() && foot.seen_standing)
      foot.held += (foot.seen - foot.held) * (1.0f - std::exp(-seconds / kToSeen_s));
    foot.shift.offset = foot.held - raw;
    foot.shift.velocity = (foot.shift.offset - offset_before) / seconds;
    return;
  }
  foot.shift.advance(Spring::y_of_half_life(settings_.release_half_life), seconds);
  if (foot.shift.is_at_rest()) foot.shift = Spring();
}

void FootLock::move_leg(const Limb& leg, const Vector3f& offset, Pose& pose, BodyFrames& frames) {
  const std::size_t upper = index_of(leg.upper), lower = index_of(leg.lower),
                    end = index_of(leg.end);
  const Vector3f hip = frames.p_WB_m[upper], knee = frames.p_WB_m[lower],
                 ankle = frames.p_WB_m[end];
  const Quaternionf R_WU = frames.R_WB[upper], R_WL = frames.R_WB[lower], R_WE = frames.R_WB[end];
  // Reach of the leg: as far as it was, then saturating towards straight.
  const float straight_m =
      kStraight * (skeleton_.offset_m[lower].norm() + skeleton_.offset_m[end].norm());
  const float was_m = (ankle - hip).norm();
  Vector3f target = ankle + offset;
  const float wanted_m = (target - hip).norm();
  if (wanted_m > was_m) {
    const float room_m = std::max(1e-4f, straight_m - was_m), extra_m = wanted_m - was_m;
    target = hip + (target - hip) * ((was_m + extra_m * room_m / (extra_m + room_m)) / wanted_m);
  }
  // The knee keeps its side; a nearly straight one bends forward.
  const Vector3f along = (ankle - hip).normalized();
  const Vector3f bend = (knee - hip) - along * along.dot(knee - hip);
  solve_two_bone(skeleton_, leg, target, bend + 0.005f * (R_WU * Vector3f::UnitZ()), R_WE, pose,
                 frames);
  // Positions are final; bones turn to them the short way, so that thigh and shank keep their
  // twist.
  const Vector3f new_knee = frames.p_WB_m[lower], new_ankle = frames.p_WB_m[end];
  frames.R_WB[upper] = turned(knee - hip, new_knee - hip, R_WU);
  frames.R_WB[lower] = turned(ankle - knee, new_ankle - new_knee, R_WL);
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * frames.R_WB[upper]).normalized();
  pose.R_PB[lower] = (frames.R_WB[upper].conjugate() * frames.R_WB[lower]).normalized();
  pose.R_PB[end] = (frames.R_WB[lower].conjugate() * R_WE).normalized();
}

bool FootLock::apply(MonoTime now, Pose& pose, bool may_lock) {
  BodyFrames frames;
  forward_kinematics(skeleton_, pose, frames);
  const std::array<Vector3f, 2> balls{frames.position(kBalls[0]), frames.position(kBalls[1])};
  if (!balls[0].allFinite() || !balls[1].allFinite()) {
    clear();
    return false;
  }
  const Duration step = now - time_;
  const auto seconds = static_cast<float>(step.as_seconds());
  const bool goes_on = began_ && step > Duration() && step <= kLongestStep &&
                       (balls[0] - feet_[0].raw).norm() < kFastestBall_m_s * seconds;
  time_ = now;
  const float low_m = std::min(balls[0].y(), balls[1].y());
  if (!goes_on) {
    if (!seen_at_.is_set() && (!began_ || std::abs(low_m - floor_m_) > kElsewhere_m))
      floor_m_ = low_m;
    for (std::size_t side = 0; side < 2; ++side) {
      Foot& foot = feet_[side];
      foot.raw = balls[side];
      foot.speed_m_s = settings_.seen_release_above_m_s;
      foot.shift = Spring();
      foot.locked = false;
    }
    began_ = true;
    is_foreseen_ = false;
    return false;
  }
  if (!seen_at_.is_set()) follow_floor(low_m, seconds);
  bool is_moved = false;
  for (std::size_t side = 0; side < 2; ++side) {
    follow(feet_[side], balls[side], seconds, may_lock);
    const Vector3f& offset = feet_[side].shift.offset;
    if (offset.cwiseAbs().maxCoeff() < kNothing_m) continue;
    move_leg(kLegs[side], offset, pose, frames);
    is_moved = true;
  }
  is_foreseen_ = false;
  return is_moved;
}

}  // namespace dance
