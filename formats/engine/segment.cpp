#include "formats/engine/segment.h"

#include <cmath>

#include "core/base/beat.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance::engine {
namespace {

// The writer stores unit rotations, so that readers need not normalise: what is further off than
// rounding is not the writer's.
constexpr float kUnitError = 1e-3f;

template <std::size_t kCount>
bool are_unit(const float (&rotations_xyzw)[kCount][4]) {
  bool are = true;
  for (const auto& q : rotations_xyzw) {
    const float n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    are &= std::abs(n - 1.0f) < kUnitError;  // false for NaN
  }
  return are;
}

}  // namespace

bool is_valid(const StoredPose& pose) {
  if (!are_unit(pose.rotation_xyzw)) return false;
  for (const float x : pose.hips_m)
    if (!(std::abs(x) <= kMaxStageDistance_m)) return false;
  if (!(pose.confidence >= 0.0f && pose.confidence <= 1.0f)) return false;
  if ((pose.presence & ~kAllBones) != 0) return false;
  if (std::isinf(pose.music_beats)) return false;
  if (!is_time(pose.capture_ns) || !is_time(pose.staged_ns)) return false;
  return std::abs(pose.staged_ns - pose.capture_ns) <= kLongestLag_ns &&
         pose.lag_ns >= -kLongestLag_ns && pose.lag_ns <= kLongestLag_ns;
}

bool is_valid(const StoredHands& hands) {
  return are_unit(hands.rotation_xyzw) && (hands.presence & ~kAllFingers) == 0 &&
         is_time(hands.capture_ns);
}

bool is_valid(const StoredSkeleton& skeleton) {
  Skeleton checked;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    checked.offset_m[b] = Eigen::Vector3f(skeleton.offset_m[b]);
  for (std::size_t t = 0; t < kTipCount; ++t) checked.tip_m[t] = Eigen::Vector3f(skeleton.tip_m[t]);
  return dance::is_valid(checked);
}

bool is_valid(const StoredBeat& beat) {
  Beat checked;
  checked.beat = beat.beat;
  checked.tempo_bpm = beat.tempo_bpm;
  checked.beats_per_bar = beat.beats_per_bar;
  checked.confidence = beat.confidence;
  return dance::is_valid(checked) && beat.playing <= 1 && is_time(beat.time_ns) &&
         is_time(beat.beat_time_ns);
}

}  // namespace dance::engine
