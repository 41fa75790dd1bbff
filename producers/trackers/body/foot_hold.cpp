#include "producers/trackers/body/foot_hold.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kHoldAbove = 0.3f, kReleaseBelow = 0.15f;  // probabilities
constexpr float kHoldBelow_m = 0.07f;                      // of the ball over its rest
constexpr float kFurthest_m = 0.25f, kCaughtUp_m = 0.03f;
constexpr float kDown_s = 0.03f;
constexpr float kLiftOfShift = 0.3f, kMostLift_m = 0.05f;
constexpr float kJump_m = 1.0f;
constexpr Duration kReleaseHalfLife = Duration::ms(70);

}  // namespace

bool FootHold::should_hold(const Vector3f& ball, float rest_m, float stands) const {
  if (!is_held_) return !is_catching_up_ && stands > kHoldAbove && ball.y() - rest_m < kHoldBelow_m;
  const float apart = std::hypot(ball.x() - held_.x(), ball.z() - held_.z());
  return stands > kReleaseBelow && apart < kFurthest_m;
}

Place FootHold::follow(const Place& goal, const Vector3f& o_ball, float rest_m, float stands,
                       float seconds) {
  const Vector3f ball = goal.p_W_m + goal.R_W * o_ball;
  if (!began_ || (ball - goal_before_).norm() > kJump_m) {
    reset();
    shown_ = ball;
    began_ = true;
  }
  goal_before_ = ball;
  const bool was_held = is_held_;
  is_held_ = should_hold(ball, rest_m, stands);
  if (is_held_) {
    if (!was_held) held_ = shown_;
    held_.y() += (rest_m - held_.y()) * (1.0f - std::exp(-seconds / kDown_s));
    shift_.offset = held_ - ball;
    shift_.velocity.setZero();
    shown_ = held_;
    return {shown_ - goal.R_W * o_ball, goal.R_W};
  }
  if (was_held) is_catching_up_ = stands > kReleaseBelow;
  shift_.advance(Spring::y_of_half_life(kReleaseHalfLife), seconds);
  if (shift_.is_at_rest()) shift_ = Spring();
  const float apart = std::hypot(shift_.offset.x(), shift_.offset.z());
  if (apart < kCaughtUp_m) is_catching_up_ = false;
  shown_ = ball + shift_.offset;
  // A foot that catches up does not drag over the floor.
  const float lift = is_catching_up_ ? std::min(kMostLift_m, kLiftOfShift * apart) : 0.0f;
  const float least = rest_m + lift;
  if (shown_.y() < least)
    shown_.y() += (least - shown_.y()) * (1.0f - std::exp(-seconds / kDown_s));
  return {shown_ - goal.R_W * o_ball, goal.R_W};
}

}  // namespace dance
