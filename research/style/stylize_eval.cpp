#include "research/style/stylize_eval.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"
#include "testing/motion/motion_measures.h"
#include "testing/motion/take_grid.h"
#include "transformers/style/stylize.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::array<double, 5> kMeasuredHarmonics{0.5, 1.0, 1.5, 2.0, 3.0};
constexpr int kLineTerms = 2 + 2 * static_cast<int>(kMeasuredHarmonics.size());
constexpr double kDegrees = 180.0 / std::numbers::pi;
// A radian of the pelvis' tilt counts as so much sway.
constexpr float kTiltLever_m = 0.2f;

using Rotations = std::vector<std::array<Quaternionf, kBoneCount>>;

// Local rotations, of the hips the tilt.
Rotations rotations_of(std::span<const Pose> poses) {
  Rotations all;
  for (const Pose& pose : poses) {
    all.push_back(pose.R_PB);
    all.back()[0] = heading_turn(pose.R_PB[0]).conjugate() * pose.R_PB[0];
  }
  return all;
}

Quaternionf mean_of(const Rotations& rotations, std::size_t bone) {
  Quaternionf mean = rotations.front()[bone];
  for (int round = 0; round < 4; ++round) {
    Vector3f sum = Vector3f::Zero();
    for (const auto& R : rotations) sum += rotation_vector(mean.conjugate() * R[bone]);
    mean = (mean * exp_rotation(sum / static_cast<float>(rotations.size()))).normalized();
  }
  return mean;
}

// The deviations of a zone, channel by channel.
using Signal = std::vector<double>;
std::vector<Signal> deviations(BodyZone zone, const Skeleton& skeleton, std::span<const Pose> poses,
                               const Rotations& rotations, const Rotations& mean_from) {
  std::vector<Signal> channels;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    if (kZoneOfBone[b] != zone) continue;
    const Quaternionf mean = mean_of(mean_from, b);
    const std::size_t first = channels.size();
    channels.resize(first + 3);
    for (const auto& R : rotations) {
      const Vector3f v = (b == 0 ? kTiltLever_m : 1.0f) * rotation_vector(mean.conjugate() * R[b]);
      for (int i = 0; i < 3; ++i) channels[first + static_cast<std::size_t>(i)].push_back(v[i]);
    }
  }
  if (zone != BodyZone::kHips) return channels;
  channels.resize(channels.size() + 2);
  BodyFrames frames;
  for (const Pose& pose : poses) {
    forward_kinematics(skeleton, pose, frames);
    const Vector3f feet =
        0.5f * (frames.position(Bone::kLeftFoot) + frames.position(Bone::kRightFoot));
    const Vector3f sway = heading_turn(pose.R_PB[0]).conjugate() * (pose.p_WH_m - feet);
    channels[channels.size() - 2].push_back(sway.x());
    channels[channels.size() - 1].push_back(sway.y());
  }
  return channels;
}

// Sines and cosines at the bar's harmonics, beside a constant and a slope, by least squares over
// all frames.
class LineFit {
 public:
  LineFit(std::span<const Pose> poses, std::span<const double> bars) {
    const std::size_t n = poses.size();
    terms_.resize(static_cast<Eigen::Index>(n), kLineTerms);
    for (std::size_t i = 0; i < n; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      terms_(row, 0) = 1.0;
      terms_(row, 1) = static_cast<double>(i) / static_cast<double>(n) - 0.5;
      for (std::size_t h = 0; h < kMeasuredHarmonics.size(); ++h) {
        const double angle = 2.0 * std::numbers::pi * kMeasuredHarmonics[h] * bars[i];
        const auto column = static_cast<Eigen::Index>(2 + 2 * h);
        terms_(row, column) = std::cos(angle);
        terms_(row, column + 1) = std::sin(angle);
      }
    }
    solver_.compute(terms_.transpose() * terms_);
  }
  Eigen::VectorXd fit(const Signal& signal) const {
    const Eigen::Map<const Eigen::VectorXd> y(signal.data(),
                                              static_cast<Eigen::Index>(signal.size()));
    return solver_.solve(terms_.transpose() * y);
  }

 private:
  Eigen::MatrixXd terms_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

double spread(const Signal& signal) {
  double mean = 0.0, sum = 0.0;
  for (const double v : signal) mean += v / static_cast<double>(signal.size());
  for (const double v : signal) sum += (v - mean) * (v - mean);
  return sum;
}

void measure_gain(const std::vector<Signal>& was, const std::vector<Signal>& is,
                  const LineFit& lines, StylizeEval& out) {
  double along = 0.0, across = 0.0, energy = 0.0, spread_was = 0.0, spread_is = 0.0;
  for (std::size_t c = 0; c < was.size(); ++c) {
    const Eigen::VectorXd a = lines.fit(was[c]), b = lines.fit(is[c]);
    for (Eigen::Index k = 2; k < kLineTerms; k += 2) {
      along += a[k] * b[k] + a[k + 1] * b[k + 1];
      across += a[k] * b[k + 1] - a[k + 1] * b[k];
      energy += a[k] * a[k] + a[k + 1] * a[k + 1];
    }
    spread_was += spread(was[c]);
    spread_is += spread(is[c]);
  }
  const double frames = static_cast<double>(was.front().size());
  out.line_energy = energy;
  out.measured_gain = energy > 0.0 ? along / energy : 0.0;
  out.phase_deg = kDegrees * std::atan2(across, along);
  out.overall_gain = spread_was > 0.0 ? std::sqrt(spread_is / spread_was) : 0.0;
  out.periodic_share = spread_was > 0.0 ? 0.5 * frames * energy / spread_was : 0.0;
}

// Of legs, what swings can be shown larger: how far the joints of a leg go from their mean while
// its ankle is faster than kSwings_m_s, of how far they were danced.
void measure_swings(const StyleTake& take, std::span<const Pose> poses, const Rotations& was,
                    const Rotations& is, StylizeEval& out) {
  constexpr double kSwings_m_s = 0.6;
  constexpr std::size_t kJointsOfLeg = 3;
  const JointTrack track(take.skeleton, poses, take.hz);
  double along = 0.0, energy = 0.0;
  std::size_t swings = 0;
  for (const Bone thigh : {Bone::kLeftUpperLeg, Bone::kRightUpperLeg})
    for (std::size_t b = index_of(thigh); b < index_of(thigh) + kJointsOfLeg; ++b) {
      const Quaternionf back = mean_of(was, b).conjugate();
      const std::size_t ankle = index_of(thigh) + kJointsOfLeg - 1;
      for (std::size_t i = 1; i < was.size(); ++i) {
        const float step_m = (track.world[i][ankle] - track.world[i - 1][ankle]).norm();
        if (static_cast<double>(step_m) * take.hz < kSwings_m_s) continue;
        const Vector3f danced = rotation_vector(back * was[i][b]);
        along += static_cast<double>(danced.dot(rotation_vector(back * is[i][b])));
        energy += static_cast<double>(danced.squaredNorm());
        ++swings;
      }
    }
  out.swing_gain = energy > 0.0 ? along / energy : 0.0;
  out.swing_share =
      static_cast<double>(swings) / static_cast<double>(2 * kJointsOfLeg * was.size());
}

void measure_others(BodyZone zone, const Rotations& was, const Rotations& is, StylizeEval& out) {
  const bool legs_are_solved = zone == BodyZone::kHips || zone == BodyZone::kLegs;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    if (kZoneOfBone[b] == zone) {
      const float shift = mean_of(was, b).angularDistance(mean_of(is, b));
      out.mean_pose_shift_deg =
          std::max(out.mean_pose_shift_deg, kDegrees * static_cast<double>(shift));
      continue;
    }
    if (legs_are_solved && kZoneOfBone[b] == BodyZone::kLegs) continue;
    for (std::size_t i = 0; i < was.size(); ++i)
      out.other_zones_change_deg = std::max(
          out.other_zones_change_deg,
          kDegrees * static_cast<double>(rotation_vector(was[i][b].conjugate() * is[i][b]).norm()));
  }
}

void measure_places(const StyleTake& take, std::span<const Pose> was, std::span<const Pose> is,
                    StylizeEval& out) {
  const JointTrack before(take.skeleton, was, take.hz), after(take.skeleton, is, take.hz);
  out.bone_length_error_mm = 1e3 * after.bone_length_error_m;
  const double jerk = jerk_m_s3(before, Places::kWorld);
  out.jerk_ratio = jerk > 0.0 ? jerk_m_s3(after, Places::kWorld) / jerk : 0.0;
  const Stance stance = stance_of(before);
  out.slide_mm_s = 1e3 * slide_m_s(after, stance);
  out.danced_slide_mm_s = 1e3 * slide_m_s(before, stance);
  std::vector<double> moved_mm;
  for (std::size_t i = 0; i < before.size(); ++i)
    for (const Bone foot : {Bone::kLeftFoot, Bone::kRightFoot}) {
      const float moved_m =
          (before.world[i][index_of(foot)] - after.world[i][index_of(foot)]).norm();
      moved_mm.push_back(1e3 * static_cast<double>(moved_m));
    }
  std::sort(moved_mm.begin(), moved_mm.end());
  out.feet_moved_mm = moved_mm.back();
  out.feet_moved_p99_mm = moved_mm[moved_mm.size() * 99 / 100];
}

bool is_same(const Pose& a, const Pose& b) {
  return std::memcmp(a.R_PB.data(), b.R_PB.data(), sizeof(a.R_PB)) == 0 && a.p_WH_m == b.p_WH_m;
}

}  // namespace

StylizeEval evaluate_stylize(const StyleTake& take, const StylizeEvalOptions& options) {
  Style style;
  style.gain[index_of(options.zone)] = static_cast<float>(options.gain);
  style.dynamic = static_cast<float>(options.mix);
  Stylize filter(style);
  filter.set_body(take.skeleton);
  std::vector<Pose> shown = take.poses;
  const auto begin = std::chrono::steady_clock::now();
  for (Pose& pose : shown) {
    if (options.untagged) pose.music_beats = kNoMusic;
    filter.observe(pose, pose.capture_time);
    filter.apply(pose.capture_time, pose);
  }
  const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;

  StylizeEval out;
  out.name = take.name;
  out.ns_per_pose = took.count() / static_cast<double>(shown.size());
  out.is_identical = std::equal(shown.begin(), shown.end(), take.poses.begin(), is_same);
  const auto from = static_cast<std::size_t>(options.warm_up_s * take.hz);
  if (from + 2 * kLineTerms > shown.size()) return out;
  const std::span<const Pose> was = std::span(take.poses).subspan(from),
                              is = std::span<const Pose>(shown).subspan(from);
  std::vector<double> bars;
  for (const Pose& pose : was) bars.push_back(pose.music_beats / Period::kBeatsPerBar);
  const Rotations turns_was = rotations_of(was), turns_is = rotations_of(is);
  measure_gain(deviations(options.zone, take.skeleton, was, turns_was, turns_was),
               deviations(options.zone, take.skeleton, is, turns_is, turns_was), LineFit(was, bars),
               out);
  measure_others(options.zone, turns_was, turns_is, out);
  if (options.zone == BodyZone::kLegs) measure_swings(take, was, turns_was, turns_is, out);
  measure_places(take, was, is, out);
  return out;
}

StylizeEval sum_up(std::span<const StylizeEval> takes) {
  StylizeEval sum;
  sum.is_identical = true;
  for (const StylizeEval& take : takes) sum.line_energy += take.line_energy;
  const double count = static_cast<double>(takes.size());
  for (const StylizeEval& take : takes) {
    const double share = sum.line_energy > 0.0 ? take.line_energy / sum.line_energy : 1.0 / count;
    sum.measured_gain += share * take.measured_gain;
    sum.phase_deg += share * take.phase_deg;
    sum.overall_gain += take.overall_gain / count;
    sum.periodic_share += take.periodic_share / count;
    sum.swing_gain += take.swing_gain / count;
    sum.swing_share += take.swing_share / count;
    sum.slide_mm_s += take.slide_mm_s / count;
    sum.danced_slide_mm_s += take.danced_slide_mm_s / count;
    sum.jerk_ratio += take.jerk_ratio / count;
    sum.ns_per_pose += take.ns_per_pose / count;
    const auto largest = [&](double StylizeEval::*of) { sum.*of = std::max(sum.*of, take.*of); };
    largest(&StylizeEval::mean_pose_shift_deg);
    largest(&StylizeEval::bone_length_error_mm);
    largest(&StylizeEval::other_zones_change_deg);
    largest(&StylizeEval::feet_moved_mm);
    largest(&StylizeEval::feet_moved_p99_mm);
    sum.is_identical = sum.is_identical && take.is_identical;
  }
  return sum;
}

}  // namespace dance
