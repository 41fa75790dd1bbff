#include "transformers/style/motion_split.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A mean pose that follows a change of hold within a figure or two, and none within a bar.
constexpr double kMeanPose_s = 6.0;
constexpr double kFirstMeanPose_s = 0.5;
// The harmonics are told apart over this long …
constexpr double kMemory_bars = 2.0;
// … and what the fit missed counts again so much: a change of the dance is followed within 1 / (1 +
// so much) of it.
constexpr float kMissedAgain = 1.5f;
// A position so far from where the last one leads is another place of the music.
constexpr double kSplitJump_bars = 0.25;
constexpr double kShy_bars = 1.0, kSure_bars = 2.5;
constexpr std::size_t kSwayChannel = 3 * kBoneCount;

HarmonicFit::Channels channels_of(const MotionSplit::Part& part) {
  HarmonicFit::Channels out{};
  for (std::size_t b = 0; b < kBoneCount; ++b)
    for (int i = 0; i < 3; ++i) out[3 * b + static_cast<std::size_t>(i)] = part.turn[b][i];
  for (int i = 0; i < 3; ++i) out[kSwayChannel + static_cast<std::size_t>(i)] = part.sway_m[i];
  return out;
}

Vector3f three_of(const HarmonicFit::Channels& channels, std::size_t at) {
  return {channels[at], channels[at + 1], channels[at + 2]};
}

}  // namespace

void MotionSplit::forget() { *this = MotionSplit(); }

double MotionSplit::mean_share(double dt_s) const {
  return dt_s / std::min(kMeanPose_s, kFirstMeanPose_s + seen_s_);
}

float MotionSplit::trust() const {
  return static_cast<float>(smooth_step((seen_bars_ - kShy_bars) / (kSure_bars - kShy_bars)));
}

Quaternionf MotionSplit::turned(std::size_t bone, const Vector3f& deviation) const {
  return (mean_turn_[bone] * exp_rotation(deviation)).normalized();
}

void MotionSplit::split(const Pose& pose, const BodyFrames& frames, double bars, Parts& out) {
  out.R_heading = heading_turn(pose.R_PB[0]);
  const Quaternionf R_tilt = out.R_heading.conjugate() * pose.R_PB[0];
  const Vector3f feet =
      0.5f * (frames.position(Bone::kLeftFoot) + frames.position(Bone::kRightFoot));
  const Vector3f sway = out.R_heading.conjugate() * (pose.p_WH_m - feet);
  if (!has_mean_) {
    mean_turn_ = pose.R_PB;
    mean_turn_[0] = R_tilt;
    mean_sway_m_ = sway;
    has_mean_ = true;
  }
  for (std::size_t b = 0; b < kBoneCount; ++b)
    out.deviation.turn[b] =
        rotation_vector(mean_turn_[b].conjugate() * (b == 0 ? R_tilt : pose.R_PB[b]));
  out.deviation.sway_m = sway - mean_sway_m_;

  HarmonicFit::Channels periodic{};
  if (std::isfinite(bars) && seen_bars_ > kShy_bars) {
    fit_.periodic_at(bars, periodic);
    const float sure = trust();
    for (float& p : periodic) p *= sure;
  }
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    out.periodic.turn[b] = three_of(periodic, 3 * b);
    out.rest.turn[b] = out.deviation.turn[b] - out.periodic.turn[b];
  }
  out.periodic.sway_m = three_of(periodic, kSwayChannel);
  out.rest.sway_m = out.deviation.sway_m - out.periodic.sway_m;
}

void MotionSplit::learn(const Parts& parts, double bars, double dt_s) {
  // The periodic part is left out of the means: they stand still through the bars, and what is
  // scaled keeps its phase.
  const auto share = static_cast<float>(mean_share(dt_s));
  for (std::size_t b = 0; b < kBoneCount; ++b)
    mean_turn_[b] = turned(b, share * parts.rest.turn[b]);
  mean_sway_m_ += share * parts.rest.sway_m;
  seen_s_ += dt_s;

  if (!std::isfinite(bars)) {
    has_bars_ = false;
    return;
  }
  if (has_bars_) {
    const double step = bars - bars_;
    if (std::abs(step - bars_per_s_ * dt_s) > kSplitJump_bars) {
      fit_.forget();
      seen_bars_ = 0.0;
    } else {
      bars_per_s_ += std::min(1.0, 2.0 * dt_s) * (step / dt_s - bars_per_s_);
      seen_bars_ += std::max(0.0, step);
    }
  }
  has_bars_ = true;
  bars_ = bars;
  const double bar_s = 1.0 / std::clamp(bars_per_s_, 0.1, 2.0);
  HarmonicFit::Channels channels = channels_of(parts.deviation);
  if (const float sure = trust(); sure > 0.0f) {
    const HarmonicFit::Channels shown = channels_of(parts.periodic);
    for (std::size_t c = 0; c < channels.size(); ++c)
      channels[c] += kMissedAgain * (sure * channels[c] - shown[c]);
  }
  fit_.add(bars, dt_s, kMemory_bars * bar_s, channels);
}

}  // namespace dance
