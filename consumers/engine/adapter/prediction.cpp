#include "consumers/engine/adapter/prediction.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// Along the tangent at `to`, away from `from`, and back onto the sphere: with c = to · from and the
// tangent c · to − from, of length √(1 − c²). A bone nears a quarter turn of its quaternion and
// never gets there. In three loops, of which the compiler makes vectors.
void turn_on(const BoneRotations& to, const BoneRotations& from, float part,
             BoneRotations& turned) {
  std::array<float, kBoneCount> dot, of_to, of_from;
  for (std::size_t b = 0; b < kBoneCount; ++b) dot[b] = to[b].coeffs().dot(from[b].coeffs());
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float c = std::abs(dot[b]);
    const float length = std::sqrt(1.0f + part * part * std::max(0.0f, 1.0f - c * c));
    const bool is_told = c >= kLeastDot;
    of_to[b] = is_told ? (1.0f + part * c) / length : 1.0f;
    of_from[b] = is_told ? std::copysign(part / length, -dot[b]) : 0.0f;
  }
  for (std::size_t b = 0; b < kBoneCount; ++b)
    turned[b].coeffs() = of_to[b] * to[b].coeffs() + of_from[b] * from[b].coeffs();
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
  turn_on(history.newest().R_PB, before->R_PB, part, pose.R_PB);
  // The music does not slow down.
  pose.music_beats += (pose.music_beats - before->music_beats) * ahead.as_seconds() / step_s;
  return pose;
}

}  // namespace dance::engine
