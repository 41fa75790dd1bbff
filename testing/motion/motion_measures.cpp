#include "testing/motion/motion_measures.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/pose/kinematics.h"

namespace dance {

using Eigen::Vector3f;
using Joints = JointTrack::Joints;

namespace {

constexpr double kStanceSpeed_m_s = 0.15;
constexpr float kStanceHeight_m = 0.05f;
constexpr double kFloorQuantile = 0.05;
constexpr std::array<std::size_t, 2> kBalls{index_of(Bone::kLeftToes), index_of(Bone::kRightToes)};

Joints body_places(const BodyFrames& frames) {
  Joints places;
  const Eigen::Quaternionf R_HW = frames.R_WB[0].conjugate().normalized();
  for (std::size_t b = 0; b < kBoneCount; ++b)
    places[b] = R_HW * (frames.p_WB_m[b] - frames.p_WB_m[0]);
  return places;
}

double mean_distance_m(const Joints& a, const Joints& b) {
  double sum = 0.0;
  for (std::size_t j = 1; j < kBoneCount; ++j) sum += static_cast<double>((a[j] - b[j]).norm());
  return sum / (kBoneCount - 1);
}

const std::vector<Joints>& places_of(const JointTrack& track, Places places) {
  return places == Places::kWorld ? track.world : track.body;
}

double mean_over(const std::vector<Joints>& a, const std::vector<Joints>& b, std::size_t from,
                 std::size_t to) {
  to = std::min({to, a.size(), b.size()});
  if (from >= to) return 0.0;
  double sum = 0.0;
  for (std::size_t i = from; i < to; ++i) sum += mean_distance_m(a[i], b[i]);
  return sum / static_cast<double>(to - from);
}

// Mean distance relative to the hips, where the track is `late` frames behind.
double shifted_error_m(const JointTrack& track, const JointTrack& truth, int late,
                       std::size_t edge) {
  double sum = 0.0;
  const std::size_t n = std::min(track.size(), truth.size());
  for (std::size_t i = edge; i + edge < n; ++i) {
    const Joints& a = track.world[i];
    const Joints& b = truth.world[static_cast<std::size_t>(static_cast<int>(i) - late)];
    for (std::size_t j = 1; j < kBoneCount; ++j)
      sum += static_cast<double>(((a[j] - a[0]) - (b[j] - b[0])).norm());
  }
  return sum;
}

}  // namespace

JointTrack::JointTrack(const Skeleton& skeleton, std::span<const Pose> poses, double rate_hz)
    : hz(rate_hz) {
  DANCE_ASSERT(rate_hz > 0.0, rate_hz);
  world.reserve(poses.size());
  body.reserve(poses.size());
  BodyFrames frames;
  for (const Pose& pose : poses) {
    forward_kinematics(skeleton, pose, frames);
    world.push_back(frames.p_WB_m);
    body.push_back(body_places(frames));
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      const float length_m = (frames.p_WB_m[b] - frames.p_WB_m[parent]).norm();
      bone_length_error_m =
          std::max(bone_length_error_m,
                   static_cast<double>(std::abs(length_m - skeleton.offset_m[b].norm())));
    }
  }
}

double body_error_m(const Skeleton& skeleton, const Pose& a, const Pose& b) {
  BodyFrames frames_a, frames_b;
  forward_kinematics(skeleton, a, frames_a);
  forward_kinematics(skeleton, b, frames_b);
  return mean_distance_m(body_places(frames_a), body_places(frames_b));
}

double body_error_m(const JointTrack& a, const JointTrack& b, std::size_t from, std::size_t to) {
  return mean_over(a.body, b.body, from, to);
}

double body_error_m(const JointTrack& a, const JointTrack& b) {
  return mean_over(a.body, b.body, 0, a.size());
}

double world_error_m(const JointTrack& a, const JointTrack& b, std::size_t from, std::size_t to) {
  return mean_over(a.world, b.world, from, to);
}

double jerk_m_s3(const JointTrack& track, Places places) {
  const std::vector<Joints>& p = places_of(track, places);
  if (p.size() < 4) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 3; i < p.size(); ++i)
    for (std::size_t j = 1; j < kBoneCount; ++j)
      sum += static_cast<double>(
          (p[i][j] - 3.0f * p[i - 1][j] + 3.0f * p[i - 2][j] - p[i - 3][j]).norm());
  const auto count = static_cast<double>((p.size() - 3) * (kBoneCount - 1));
  return sum / count * track.hz * track.hz * track.hz;
}

double activity_m_s(const JointTrack& track, Places places, std::size_t from, std::size_t to) {
  const std::vector<Joints>& p = places_of(track, places);
  from = std::max<std::size_t>(from, 1);
  to = std::min(to, p.size());
  if (from >= to) return 0.0;
  double sum = 0.0;
  for (std::size_t i = from; i < to; ++i) sum += mean_distance_m(p[i], p[i - 1]);
  return sum / static_cast<double>(to - from) * track.hz;
}

double activity_m_s(const JointTrack& track, Places places) {
  return activity_m_s(track, places, 0, track.size());
}

double peak_speed_m_s(const JointTrack& track, Places places, std::size_t from, std::size_t to) {
  const std::vector<Joints>& p = places_of(track, places);
  double peak_m = 0.0;
  for (std::size_t i = std::max<std::size_t>(from, 1); i < std::min(to, p.size()); ++i)
    for (std::size_t j = 0; j < kBoneCount; ++j)
      peak_m = std::max(peak_m, static_cast<double>((p[i][j] - p[i - 1][j]).norm()));
  return peak_m * track.hz;
}

Stance stance_of(const JointTrack& track) {
  Stance stance;
  const std::size_t n = track.size();
  stance.stands.assign(n, {false, false});
  if (n < 2) return stance;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::size_t ball = kBalls[side];
    std::vector<float> heights_m;
    for (const Joints& joints : track.world) heights_m.push_back(joints[ball].y());
    const auto low = heights_m.begin() +
                     static_cast<std::ptrdiff_t>(kFloorQuantile * static_cast<double>(n - 1));
    std::nth_element(heights_m.begin(), low, heights_m.end());
    const float floor_m = *low;
    for (std::size_t i = 1; i < n; ++i) {
      const Vector3f& p = track.world[i][ball];
      const double speed_m_s =
          static_cast<double>((p - track.world[i - 1][ball]).norm()) * track.hz;
      stance.stands[i][side] = speed_m_s < kStanceSpeed_m_s && p.y() < floor_m + kStanceHeight_m;
    }
  }
  return stance;
}

double slide_m_s(const JointTrack& track, const Stance& stance, int late) {
  double sum_m = 0.0;
  std::size_t count = 0;
  const auto n = static_cast<int>(std::min(track.size(), stance.stands.size()));
  for (int i = std::max(1, late); i < std::min(n, n + late); ++i) {
    const auto frame = static_cast<std::size_t>(i);
    for (std::size_t side = 0; side < 2; ++side) {
      if (!stance.stands[static_cast<std::size_t>(i - late)][side]) continue;
      Vector3f step_m = track.world[frame][kBalls[side]] - track.world[frame - 1][kBalls[side]];
      step_m.y() = 0.0f;
      sum_m += static_cast<double>(step_m.norm());
      ++count;
    }
  }
  return count ? sum_m / static_cast<double>(count) * track.hz : 0.0;
}

double effective_lag_s(const JointTrack& track, const JointTrack& truth, double most_s) {
  DANCE_ASSERT(track.hz == truth.hz, track.hz, truth.hz);
  const int most = static_cast<int>(std::lround(most_s * track.hz));
  const auto edge = static_cast<std::size_t>(most) + 1;
  if (std::min(track.size(), truth.size()) <= 2 * edge) return 0.0;
  std::vector<double> errors;
  for (int late = -most - 1; late <= most + 1; ++late)
    errors.push_back(shifted_error_m(track, truth, late, edge));
  const auto least = std::min_element(errors.begin() + 1, errors.end() - 1);
  const int best = static_cast<int>(least - errors.begin()) - most - 1;
  // The least of the parabola through the three shifts about the best.
  const auto at = static_cast<std::size_t>(best + most + 1);
  const double before = errors[at - 1], here = errors[at], after = errors[at + 1];
  const double bend = before - 2.0 * here + after;
  const double between = bend > 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return (static_cast<double>(best) + std::clamp(between, -0.5, 0.5)) / track.hz;
}

PlayRate play_rate(std::span<const Pose> shown, double hz) {
  PlayRate rate;
  if (shown.size() < 2) return rate;
  for (std::size_t i = 1; i < shown.size(); ++i) {
    const double step = (shown[i].capture_time - shown[i - 1].capture_time).as_seconds() * hz;
    rate.least = i == 1 ? step : std::min(rate.least, step);
    rate.most = i == 1 ? step : std::max(rate.most, step);
    rate.mean += step / static_cast<double>(shown.size() - 1);
  }
  return rate;
}

}  // namespace dance
