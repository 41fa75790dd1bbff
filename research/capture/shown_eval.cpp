#include "research/capture/shown_eval.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/program/figures.h"
#include "producers/camera/solver/shown/facing.h"

namespace dance {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double kStart_s = 1.5;
// Bones are held by then: what moves after that trembles.
constexpr double kBonesHeld_s = 6.0;
constexpr double kDeg = 180.0 / std::numbers::pi;
constexpr double kFlip_deg = 90.0, kNoFlip_deg = 45.0, kFlipWithin_s = 0.2;
constexpr double kHandMoves_m_s = 0.3, kSpins_deg_s = 150.0;

void write_facing(const std::optional<double>& facing_rad, ShownFrame& frame) {
  frame.has_facing = facing_rad.has_value();
  frame.facing_rad = facing_rad.value_or(0.0);
}

double turn_between_deg(double from_rad, double to_rad) {
  return kDeg * turn_between(from_rad, to_rad);
}

void write_frame(const Skeleton& skeleton, const Pose& pose, ShownFrame& frame) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  frame.is_there = true;
  frame.lowest_m = lowest_sole_m(skeleton, frames);
  write_facing(facing_of(skeleton, pose), frame);
  frame.hips_m = 0.5 * (frames.position(Bone::kLeftUpperLeg).cast<double>() +
                        frames.position(Bone::kRightUpperLeg).cast<double>());
  frame.wrist = {frames.position(Bone::kLeftHand).cast<double>(),
                 frames.position(Bone::kRightHand).cast<double>()};
}

SoleFigures soles_of(const ShownTrack& track, std::size_t end) {
  SoleFigures soles;
  std::vector<double> lifts;
  int over_5 = 0, over_20 = 0;
  for (std::size_t f = 0; f < std::min(end, track.frames.size()); ++f) {
    const ShownFrame& frame = track.frames[f];
    if (!frame.is_there) continue;
    const double below_mm = -1000.0 * frame.lowest_m;
    over_5 += below_mm > 5.0 ? 1 : 0;
    over_20 += below_mm > 20.0 ? 1 : 0;
    soles.worst_mm = std::max(soles.worst_mm, below_mm);
    lifts.push_back(-below_mm);
  }
  std::sort(lifts.begin(), lifts.end());
  const double percent = 100.0 / std::max(1.0, static_cast<double>(lifts.size()));
  soles.over_5_percent = percent * over_5;
  soles.over_20_percent = percent * over_20;
  soles.lift_p50_mm = percentile<double>(lifts, 0.5);
  soles.lift_p99_mm = percentile<double>(lifts, 0.99);
  return soles;
}

// The shift at which two series of speeds are most alike, between frames by a parabola: `product`
// of a frame and of the truth's, so many frames before.
template <class Product>
std::optional<double> lag_ms(int frames, double hz, Product product) {
  constexpr int kMost = 8;
  if (frames <= 4 * kMost) return std::nullopt;
  std::array<double, 2 * kMost + 1> alike{};
  for (int late = -kMost; late <= kMost; ++late)
    for (int f = kMost + 1; f < frames - kMost; ++f)
      alike[static_cast<std::size_t>(late + kMost)] += product(f, f - late);
  const auto most = std::max_element(alike.begin() + 1, alike.end() - 1);
  if (!(*most > 0.0)) return std::nullopt;
  const double bend = most[-1] - 2.0 * most[0] + most[1];
  const double between = bend < 0.0 ? 0.5 * (most[-1] - most[1]) / bend : 0.0;
  return 1000.0 * (static_cast<double>(most - alike.begin()) - kMost + between) / hz;
}

void judge_facing(const ShownTrack& shown, const ShownTrack& truth, ShownFigures& figures) {
  const std::size_t n = shown.frames.size();
  const auto within = static_cast<std::size_t>(std::lround(kFlipWithin_s * shown.hz));
  std::vector<double> errors;
  bool is_wrong = false;
  std::size_t flipped_at = 0;
  for (std::size_t f = 1; f < n; ++f) {
    const ShownFrame &now = shown.frames[f], &before = shown.frames[f - 1];
    if (!now.is_there || !now.has_facing) continue;
    if (before.is_there && before.has_facing) {
      const double turn_deg = std::abs(turn_between_deg(before.facing_rad, now.facing_rad));
      figures.most_deg = std::max(figures.most_deg, turn_deg);
      figures.fastest_deg_s = std::max(figures.fastest_deg_s, turn_deg * shown.hz);
    }
    if (!truth.frames.empty()) {
      if (!truth.frames[f].has_facing) continue;
      const double error = std::abs(turn_between_deg(truth.frames[f].facing_rad, now.facing_rad));
      errors.push_back(error);
      if (!is_wrong && error > kFlip_deg) ++figures.flips;
      is_wrong = is_wrong ? error > kNoFlip_deg : error > kFlip_deg;
    } else if (f >= within && f >= flipped_at + within) {
      const ShownFrame& earlier = shown.frames[f - within];
      if (!earlier.is_there || !earlier.has_facing ||
          std::abs(turn_between_deg(earlier.facing_rad, now.facing_rad)) <= kFlip_deg)
        continue;
      ++figures.flips;
      flipped_at = f;
    }
  }
  std::sort(errors.begin(), errors.end());
  figures.facing_error_deg = percentile<double>(errors, 0.95);
  if (truth.frames.empty()) return;
  const auto speed = [](const ShownTrack& track, int f) {
    const ShownFrame &now = track.frames[static_cast<std::size_t>(f)],
                     &before = track.frames[static_cast<std::size_t>(f) - 1];
    return now.has_facing && before.has_facing
               ? turn_between_deg(before.facing_rad, now.facing_rad) * track.hz
               : 0.0;
  };
  figures.facing_lag_ms = lag_ms(static_cast<int>(n), shown.hz, [&](int f, int true_f) {
    const double is = speed(truth, true_f);
    return std::abs(is) > kSpins_deg_s ? is * speed(shown, f) : 0.0;
  });
}

void judge_hands(const ShownTrack& shown, const ShownTrack& truth, ShownFigures& figures) {
  std::vector<double> steps_mm, errors_mm;
  const std::size_t n = shown.frames.size();
  for (auto f = static_cast<std::size_t>(kBonesHeld_s * shown.hz) + 1; f < n; ++f) {
    if (!shown.frames[f].is_there || !shown.frames[f - 1].is_there) continue;
    for (std::size_t s = 0; s < 2; ++s)
      steps_mm.push_back(1000.0 * (shown.frames[f].wrist[s] - shown.frames[f - 1].wrist[s]).norm());
    if (truth.frames.empty()) continue;
    const ShownFrame &is = shown.frames[f], &due = truth.frames[f];
    for (std::size_t s = 0; s < 2; ++s)
      errors_mm.push_back(1000.0 * (is.wrist[s] - is.hips_m - (due.wrist[s] - due.hips_m)).norm());
  }
  std::sort(errors_mm.begin(), errors_mm.end());
  for (const double e : errors_mm)
    figures.wrist_error_mm += e / static_cast<double>(errors_mm.size());
  figures.wrist_error_p95_mm = percentile<double>(errors_mm, 0.95);
  std::sort(steps_mm.begin(), steps_mm.end());
  figures.hand_p50_mm = percentile<double>(steps_mm, 0.5);
  figures.hand_p99_mm = percentile<double>(steps_mm, 0.99);
  if (truth.frames.empty()) return;
  const auto velocity = [](const ShownTrack& track, int f, std::size_t s) {
    const auto at = static_cast<std::size_t>(f);
    return Vector3d((track.frames[at].wrist[s] - track.frames[at - 1].wrist[s]) * track.hz);
  };
  figures.hand_lag_ms = lag_ms(static_cast<int>(n), shown.hz, [&](int f, int true_f) {
    double sum = 0.0;
    for (std::size_t s = 0; s < 2; ++s) {
      const Vector3d is = velocity(truth, true_f, s);
      if (is.norm() > kHandMoves_m_s) sum += is.dot(velocity(shown, f, s));
    }
    return sum;
  });
}

void add_soles(SoleFigures& sum, const SoleFigures& f, double share) {
  sum.over_5_percent += share * f.over_5_percent;
  sum.over_20_percent += share * f.over_20_percent;
  sum.worst_mm = std::max(sum.worst_mm, f.worst_mm);
  sum.lift_p50_mm += share * f.lift_p50_mm;
  sum.lift_p99_mm += share * f.lift_p99_mm;
}

}  // namespace

ShownTrack truth_track(const CaptureScene& scene) {
  ShownTrack track{scene.hz, {}};
  for (const SceneFrame& seen : scene.frames) {
    const auto at = [&seen](Landmark l) { return seen.truth_W_m[index_of(l)]; };
    ShownFrame frame;
    frame.is_there = true;
    frame.is_flipped = seen.is_flipped;
    write_facing(facing_of(at(Landmark::kLeftHip) - at(Landmark::kRightHip),
                           at(Landmark::kLeftShoulder) - at(Landmark::kRightShoulder)),
                 frame);
    frame.lowest_m = seen.lowest_sole_m;
    frame.hips_m = 0.5 * (at(Landmark::kLeftHip) + at(Landmark::kRightHip));
    frame.wrist = {at(Landmark::kLeftWrist), at(Landmark::kRightWrist)};
    track.frames.push_back(frame);
  }
  return track;
}

ShownTrack shown_track(std::span<const BodyLandmarks> landmarks, double hz, const Pinhole& camera,
                       const SolverOptions& options) {
  BodySolver solver(options, camera);
  ShownTrack track{hz, {}};
  Pose pose;
  for (const BodyLandmarks& seen : landmarks) {
    ShownFrame frame;
    if (solver.solve(seen, {}, pose)) write_frame(solver.skeleton(), pose, frame);
    track.frames.push_back(frame);
  }
  return track;
}

ShownTrack shown_track(const CaptureScene& scene, const SolverOptions& options) {
  std::vector<BodyLandmarks> landmarks;
  for (const SceneFrame& frame : scene.frames) landmarks.push_back(frame.landmarks);
  return shown_track(landmarks, scene.hz, scene.camera.pinhole, options);
}

ShownFigures shown_figures(const ShownTrack& shown, const ShownTrack& truth) {
  ShownFigures figures;
  for (const ShownFrame& frame : shown.frames) {
    ++figures.frames;
    figures.without_pose += frame.is_there ? 0 : 1;
  }
  figures.soles = soles_of(shown, shown.frames.size());
  figures.start_soles = soles_of(shown, static_cast<std::size_t>(kStart_s * shown.hz));
  judge_facing(shown, truth, figures);
  judge_hands(shown, truth, figures);
  return figures;
}

ShownFigures all_of(const std::vector<ShownFigures>& figures) {
  ShownFigures all;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, figures.size()));
  int facing_lags = 0, hand_lags = 0;
  const auto add_lag = [](std::optional<double>& mean, const std::optional<double>& one, int& n) {
    if (one) mean = mean.value_or(0.0) + (*one - mean.value_or(0.0)) / ++n;
  };
  for (const ShownFigures& f : figures) {
    add_soles(all.soles, f.soles, share);
    add_soles(all.start_soles, f.start_soles, share);
    all.fastest_deg_s = std::max(all.fastest_deg_s, f.fastest_deg_s);
    all.most_deg = std::max(all.most_deg, f.most_deg);
    all.flips += f.flips;
    all.facing_error_deg += share * f.facing_error_deg;
    add_lag(all.facing_lag_ms, f.facing_lag_ms, facing_lags);
    all.hand_p50_mm += share * f.hand_p50_mm;
    all.hand_p99_mm += share * f.hand_p99_mm;
    add_lag(all.hand_lag_ms, f.hand_lag_ms, hand_lags);
    all.wrist_error_mm += share * f.wrist_error_mm;
    all.wrist_error_p95_mm += share * f.wrist_error_p95_mm;
    all.frames += f.frames;
    all.without_pose += f.without_pose;
  }
  return all;
}

}  // namespace dance
