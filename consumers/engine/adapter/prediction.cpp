#include "consumers/engine/adapter/prediction.h"

#include <algorithm>

namespace dance::engine {
namespace {

// A speed is told over at least this long, as what is nearer together is mostly noise.
constexpr Duration kLeastBaseline = Duration::ms(14);
// cos(60°): half of the angle that a bone turned.
constexpr float kLeastDot = 0.5f;

const Pose* before_newest(const PoseHistory& history) {
  const MonoTime newest = history.newest().capture_time;
  for (std::size_t back = 1; back < history.size(); ++back) {
    const Pose& pose = history.newest(back);
    const Duration age = newest - pose.capture_time;
    if (age > PoseHistory::kCloseTogether) return nullptr;
    if (age >= kLeastBaseline) return &pose;
  }
  return nullptr;
}

double moved_s(Duration since_newest) {
  const double most = kLongestPrediction.as_seconds();
  const double s = std::clamp(since_newest.as_seconds() / most, 0.0, 1.0);
  return most * s * (1.0 - s * s + 0.5 * s * s * s);
}

}  // namespace

Pose predict(const PoseHistory& history, MonoTime t) {
  Pose pose = history.newest();
  const MonoTime captured = pose.capture_time;
  const Duration ahead = std::min(t - captured, kLongestPrediction);
  pose.capture_time = captured + ahead;
  for (MonoTime& hop : pose.hops)
    if (hop.is_set()) hop += ahead;
  const Pose* before = before_newest(history);
  if (!before) return pose;
  const double step_s = (captured - before->capture_time).as_seconds();
  // Of the step from the pose before to the newest.
  const auto part = static_cast<float>(moved_s(ahead) / step_s);
  Eigen::Vector3f way = part * (pose.p_WH_m - before->p_WH_m);
  if (const float length = way.norm(); length > kMostPredicted_m) way *= kMostPredicted_m / length;
  pose.p_WH_m += way;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    // Along the tangent, back onto the sphere: a bone nears a quarter turn of its quaternion and
    // never gets there.
    const Eigen::Vector4f& to = history.newest().R_PB[b].coeffs();
    Eigen::Vector4f from = before->R_PB[b].coeffs();
    float dot = from.dot(to);
    if (dot < 0.0f) {
      from = -from;
      dot = -dot;
    }
    if (dot < kLeastDot) continue;
    pose.R_PB[b].coeffs() = (to + part * (dot * to - from)).normalized();
  }
  // The music does not slow down.
  pose.music_beats += (pose.music_beats - before->music_beats) * ahead.as_seconds() / step_s;
  return pose;
}

}  // namespace dance::engine
