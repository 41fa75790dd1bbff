#include "viewer/instruments/prediction_check.h"

#include "core/pose/interpolate.h"

namespace dance {

void PredictionCheck::restart() {
  count_ = 0;
  has_newest_ = false;
}

void PredictionCheck::on_staged(const Pose& staged) {
  if (!has_newest_ || staged.clock_id != newest_.clock_id) return;
  if (staged.capture_time <= newest_.capture_time) return;
  if (count_ == kPending) {  // the oldest gives way
    first_ = (first_ + 1) % kPending;
    --count_;
  }
  pending_[(first_ + count_++) % kPending] = staged;
}

void PredictionCheck::on_arrived(const Pose& pose) {
  const bool is_other = has_newest_ && pose.clock_id != newest_.clock_id;
  if (is_other) restart();
  if (has_newest_ && pose.capture_time <= newest_.capture_time) return;
  const Duration gap = has_newest_ ? pose.capture_time - newest_.capture_time : Duration();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Pose& shown = pending_[(first_ + i) % kPending];
    if (shown.capture_time > pose.capture_time) {
      if (kept != i) pending_[(first_ + kept) % kPending] = shown;
      ++kept;
      continue;
    }
    if (gap > kLongestGap) continue;
    const double share = (shown.capture_time - newest_.capture_time).as_seconds();
    compare(shown, interpolate(newest_, pose, static_cast<float>(share / gap.as_seconds())));
  }
  count_ = kept;
  newest_ = pose;
  has_newest_ = true;
}

void PredictionCheck::compare(const Pose& shown, const Pose& danced) {
  hips_mm_.add(1e3f * (shown.p_WH_m - danced.p_WH_m).norm());
  Pose a = shown, b = danced;
  a.R_PB[0] = b.R_PB[0] = Eigen::Quaternionf::Identity();
  a.p_WH_m = b.p_WH_m = Eigen::Vector3f::Zero();
  BodyFrames of_a, of_b;
  forward_kinematics(skeleton_, a, of_a);
  forward_kinematics(skeleton_, b, of_b);
  for (std::size_t bone = 1; bone < kBoneCount; ++bone)
    joints_mm_.add(1e3f * (of_a.p_WB_m[bone] - of_b.p_WB_m[bone]).norm());
}

PredictionCheck::Errors PredictionCheck::take() {
  const Errors errors{joints_mm_.mean(), joints_mm_.percentile(0.95), hips_mm_.mean()};
  joints_mm_.clear();
  hips_mm_.clear();
  return errors;
}

}  // namespace dance
