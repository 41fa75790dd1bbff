#include "consumers/engine/adapter/prediction.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace dance::engine {
namespace {

// cos(60°): half of the angle that a bone turned.
constexpr float kLeastDot = 0.5f;

const Pose* before_newest(const PoseHistory& history) {
  const MonoTime newest = history.newest().capture_time;
  for (std::size_t back = 1; back < history.size(); ++back) {
    const Pose& pose = history.newest(back);
    const Duration age = newest - pose.capture_time;
    if (age > kMostBaseline) return nullptr;
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
void turn_on(const float* to, const float* from, float part, float* turned) {
  std::array<float, kBoneCount> dot, of_to, of_from;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float *p = to + 4 * b, *q = from + 4 * b;
    dot[b] = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  }
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const float c = std::abs(dot[b]);
    const float length = std::sqrt(1.0f + part * part * std::max(0.0f, 1.0f - c * c));
    const bool is_told = c >= kLeastDot;
    of_to[b] = is_told ? (1.0f + part * c) / length : 1.0f;
    of_from[b] = is_told ? std::copysign(part / length, -dot[b]) : 0.0f;
  }
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Eigen::Vector4f moved = of_to[b] * Eigen::Vector4f::Map(to + 4 * b) +
                                  of_from[b] * Eigen::Vector4f::Map(from + 4 * b);
    Eigen::Vector4f::Map(turned + 4 * b) = moved;
  }
}

Eigen::Vector3f bounded(const Eigen::Vector3f& way) {
  const float length = way.norm();
  return length > kMostPredicted_m ? Eigen::Vector3f(way * (kMostPredicted_m / length)) : way;
}

}  // namespace

Pose predict(const PoseHistory& history, MonoTime t) {
  const Pose& newest = history.newest();
  Pose pose = newest;
  const Duration ahead = std::min(t - newest.capture_time, kLongestPrediction);
  pose.capture_time += ahead;
  for (MonoTime& hop : pose.hops)
    if (hop.is_set()) hop += ahead;
  const Pose* before = before_newest(history);
  if (!before) return pose;
  const double step_s = (newest.capture_time - before->capture_time).as_seconds();
  // Of the step from the pose before to the newest.
  const auto part = static_cast<float>(moved_s(ahead) / step_s);
  pose.p_WH_m += bounded(part * (newest.p_WH_m - before->p_WH_m));
  turn_on(newest.R_PB[0].coeffs().data(), before->R_PB[0].coeffs().data(), part,
          pose.R_PB[0].coeffs().data());
  // The music does not slow down.
  pose.music_beats += (newest.music_beats - before->music_beats) * ahead.as_seconds() / step_s;
  return pose;
}

void predict(StoredPose& newest, const StoredPose& before, MonoTime t) {
  const double step_s = Duration::ns(newest.capture_ns - before.capture_ns).as_seconds();
  const Duration ahead = std::min(t - MonoTime::from_ns(newest.capture_ns), kLongestPrediction);
  const auto part = static_cast<float>(moved_s(ahead) / step_s);
  auto place = Eigen::Vector3f::Map(newest.hips_m);
  place += bounded(part * (place - Eigen::Vector3f::Map(before.hips_m)));
  turn_on(newest.rotation_xyzw[0], before.rotation_xyzw[0], part, newest.rotation_xyzw[0]);
  newest.music_beats += (newest.music_beats - before.music_beats) * ahead.as_seconds() / step_s;
}

}  // namespace dance::engine
