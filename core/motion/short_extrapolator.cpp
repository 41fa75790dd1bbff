#include "core/motion/short_extrapolator.h"

#include <algorithm>
#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/motion/saturated.h"
#include "core/motion/turn_limit.h"
#include "core/pose/kinematics.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// Faster is a jump of the sensor, or another place on the stage.
constexpr float kFastestStride_m_s = 6.0f;
constexpr float kFastestBone_rad_s = TurnLimit::kFastest_rad_s;

float lowest_m(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return std::min({frames.position(Bone::kLeftFoot).y(), frames.position(Bone::kRightFoot).y(),
                   frames.position(Bone::kLeftToes).y(), frames.position(Bone::kRightToes).y(),
                   frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y()});
}

}  // namespace

void ShortExtrapolator::observe(const Pose& pose, MonoTime moment) {
  if (count_ > 0) {
    const Duration step = moment - newest().moment;
    if (step <= Duration() && step > -kLongestGap) return;
    if (step <= Duration() || step > kLongestGap) count_ = 0;
  }
  past_[next_] = {pose, moment};
  next_ = (next_ + 1) % kKept;
  count_ = std::min(count_ + 1, kKept);
}

const ShortExtrapolator::Past* ShortExtrapolator::earlier() const {
  for (std::size_t back = 1; back < count_; ++back)
    if (newest().moment - newest(back).moment >= kSpeedOver) return &newest(back);
  return count_ > 1 ? &newest(count_ - 1) : nullptr;
}

Pose ShortExtrapolator::at(MonoTime moment, const Skeleton& skeleton) const {
  if (count_ == 0) return {};
  Pose pose = newest().pose;
  const Past* before = earlier();
  const Duration ahead = std::min(moment - newest().moment, kFurthest);
  if (before == nullptr || ahead <= Duration()) return pose;
  const auto over_s = static_cast<float>((newest().moment - before->moment).as_seconds());
  const auto fading_s = static_cast<float>(kFading.as_seconds());
  // ∫ e^(-t/τ) dt = τ (1 - e^(-t/τ)): how long the speed of now would take for the same way.
  const float lasts_s =
      fading_s * (1.0f - std::exp(-static_cast<float>(ahead.as_seconds()) / fading_s));
  const Vector3f speed = (pose.p_WH_m - before->pose.p_WH_m) / over_s;
  if (speed.norm() > kFastestStride_m_s) return pose;
  pose.p_WH_m += lasts_s * speed;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    // In the parent's axes: R(t) = exp(ω t) R.
    const Quaternionf step = newest().pose.R_PB[b] * before->pose.R_PB[b].conjugate();
    const Vector3f turn_rad_s = saturated(rotation_vector(step) / over_s, kFastestBone_rad_s);
    pose.R_PB[b] = (exp_rotation(lasts_s * turn_rad_s) * pose.R_PB[b]).normalized();
  }
  const float floor_m = std::min(0.0f, lowest_m(skeleton, newest().pose));
  pose.p_WH_m.y() += std::max(0.0f, floor_m - lowest_m(skeleton, pose));
  return pose;
}

}  // namespace dance
