#include "core/motion/turn_limit.h"

#include <cmath>

namespace dance {
namespace {

constexpr Duration kLongestFrame = Duration::ms(100);

bool is_hand(std::size_t bone) {
  return bone == index_of(Bone::kLeftHand) || bone == index_of(Bone::kRightHand);
}

}  // namespace

bool TurnLimit::apply(MonoTime now, Pose& pose, bool is_predicted) {
  const Duration step = now - time_;
  if (time_.is_set() && step == Duration()) {
    // The same moment again: a limb lags as before.
    if (is_behind_) pose.R_PB = shown_;
    return is_behind_;
  }
  const bool goes_on = time_.is_set() && step > Duration() && step <= kLongestFrame;
  time_ = now;
  const bool limits = goes_on && (is_predicted || is_behind_);
  is_behind_ = false;
  if (limits) {
    const auto seconds = static_cast<float>(step.as_seconds());
    const float half = 0.5f * kFastest_rad_s * seconds;
    const float half_of_hand = 0.5f * kFastestHand_rad_s * seconds;
    const float least = std::cos(half), least_of_hand = std::cos(half_of_hand);
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const float same = std::abs(shown_[b].dot(pose.R_PB[b]));
      if (same >= (is_hand(b) ? least_of_hand : least)) continue;
      const float share = (is_hand(b) ? half_of_hand : half) / std::acos(same);
      // Also false for NaN.
      if (!(share < 1.0f)) continue;
      pose.R_PB[b] = shown_[b].slerp(share, pose.R_PB[b]);
      is_behind_ = true;
    }
  }
  shown_ = pose.R_PB;
  return is_behind_;
}

}  // namespace dance
