#include "research/capture/capture_solve_eval.h"

#include <algorithm>
#include <cmath>

#include "core/pose/kinematics.h"
#include "core/program/figures.h"
#include "producers/camera/solver/observation.h"
#include "research/capture/thread_time.h"

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr double kStandsBelow = 0.1, kStandsUnder_m = 0.05;
// A foot that has come to rest so long ago is planted.
constexpr double kPlanted_s = 0.1;
// Over which a true foot's speed is measured, at any rate of pictures.
constexpr double kSpeedOver_s = 1.0 / 30.0;
constexpr double kWrongWay_m = 0.02;

// A knee that lies behind the line from hip to ankle, seen from where the foot points.
int wrong_knees(const JudgedTrack::Frame& frame, const std::array<Vector3d, 2>& toe) {
  int wrong = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const Vector3d &hip = frame.joint[6 + s], &knee = frame.joint[8 + s],
                   &ankle = frame.joint[10 + s];
    const Vector3d along = (ankle - hip).normalized();
    Vector3d forward = toe[s] - ankle;
    forward -= along * along.dot(forward);
    const Vector3d off = (knee - hip) - along * along.dot(knee - hip);
    if (forward.norm() > 0.03 && off.dot(forward.normalized()) < -kWrongWay_m) ++wrong;
  }
  return wrong;
}

void measure_bones(JudgedTrack::Frame& frame) {
  const auto& j = frame.joint;
  for (std::size_t s = 0; s < 2; ++s) {
    frame.bone_m[s] = (j[2 + s] - j[0 + s]).norm();
    frame.bone_m[2 + s] = (j[4 + s] - j[2 + s]).norm();
    frame.bone_m[4 + s] = (j[8 + s] - j[6 + s]).norm();
    frame.bone_m[6 + s] = (j[10 + s] - j[8 + s]).norm();
  }
}

JudgedTrack truth_of(const CaptureScene& scene) {
  JudgedTrack track;
  for (const SceneFrame& seen : scene.frames) {
    JudgedTrack::Frame frame;
    for (std::size_t i = 0; i < kJudgedCount; ++i)
      frame.joint[i] = seen.truth_W_m[index_of(kLimbJoints[i].landmark)];
    frame.foot = seen.ball_W_m;
    frame.wrong_knees = wrong_knees(frame, {seen.truth_W_m[index_of(Landmark::kLeftFootIndex)],
                                            seen.truth_W_m[index_of(Landmark::kRightFootIndex)]});
    measure_bones(frame);
    track.frames.push_back(frame);
  }
  return track;
}

JudgedTrack baseline_of(const CaptureScene& scene) {
  JudgedTrack track;
  for (const SceneFrame& frame_seen : scene.frames) {
    const Observation seen = observe(frame_seen.landmarks, scene.camera.pinhole);
    std::array<Vector3d, kLandmarkCount> world;
    for (std::size_t i = 0; i < kLandmarkCount; ++i)
      world[i] = frame_seen.landmarks.world_m[i].cast<double>();
    Vector3d place(0.0, 0.0, scene.camera.distance_m);
    place_on_rays(seen, world, place);
    JudgedTrack::Frame frame;
    const auto at = [&](Landmark l) { return scene.to_W(place + world[index_of(l)]); };
    for (std::size_t i = 0; i < kJudgedCount; ++i) frame.joint[i] = at(kLimbJoints[i].landmark);
    frame.foot = {at(Landmark::kLeftFootIndex), at(Landmark::kRightFootIndex)};
    frame.wrong_knees = wrong_knees(frame, frame.foot);
    frame.lowest_m = std::min({frame.foot[0].y(), frame.foot[1].y(), at(Landmark::kLeftHeel).y(),
                               at(Landmark::kRightHeel).y()});
    measure_bones(frame);
    track.frames.push_back(frame);
  }
  return track;
}

double lowest_of(const Skeleton& skeleton, const BodyFrames& frames) {
  float lowest = std::min(frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y());
  const float under = skeleton.offset(Bone::kLeftToes).y() + skeleton.tip(Tip::kLeftToes).y();
  for (const auto& [foot, sole_z] :
       {std::pair{Bone::kLeftFoot, skeleton.offset(Bone::kLeftToes).z()},
        std::pair{Bone::kRightFoot, skeleton.offset(Bone::kRightToes).z()}}) {
    const Eigen::Vector3f ball =
        frames.position(foot) + frames.R_WB[index_of(foot)] * Eigen::Vector3f(0.0f, under, sole_z);
    lowest = std::min(lowest, ball.y());
  }
  return static_cast<double>(lowest);
}

JudgedTrack solved_of(const CaptureScene& scene, const SolverOptions& options, SolveScore& score) {
  BodySolver solver(options, scene.camera.pinhole);
  JudgedTrack track;
  Pose pose;
  BodyFrames frames;
  std::int64_t spent_ns = 0;
  for (const SceneFrame& seen : scene.frames) {
    const std::int64_t begin_ns = thread_time_ns();
    const bool is_there = solver.solve(seen.landmarks, {}, pose);
    spent_ns += thread_time_ns() - begin_ns;
    score.refused += is_there ? 0 : 1;
    forward_kinematics(solver.skeleton(), pose, frames);
    JudgedTrack::Frame frame;
    frame.joint = limb_places(frames);
    frame.foot = {frames.position(Bone::kLeftToes).cast<double>(),
                  frames.position(Bone::kRightToes).cast<double>()};
    frame.wrong_knees = wrong_knees(frame, frame.foot);
    frame.lowest_m = lowest_of(solver.skeleton(), frames);
    for (const auto& [bone, sign] :
         {std::pair{Bone::kLeftLowerArm, 1.0f}, std::pair{Bone::kRightLowerArm, -1.0f}}) {
      // Bent backwards: the forearm behind the upper arm's hinge by more than noise.
      const Eigen::Vector3f along = pose.R_PB[index_of(bone)] * Eigen::Vector3f(sign, 0.0f, 0.0f);
      frame.wrong_elbows += along.z() < -0.05f ? 1 : 0;
    }
    measure_bones(frame);
    track.frames.push_back(frame);
  }
  score.ns_per_frame = static_cast<double>(spent_ns) / static_cast<double>(scene.frames.size());
  score.camera_height_error_mm = 1000.0 * (solver.camera_stand().height_m - scene.camera.height_m);
  score.camera_pitch_error_deg =
      (solver.camera_stand().pitch_rad - scene.camera.pitch_rad) * 57.29577951;
  score.height_error_percent =
      100.0 * (static_cast<double>(standing_height_m(solver.skeleton())) / scene.height_m - 1.0);
  return track;
}

double relative_error(const JudgedTrack::Frame& a, const JudgedTrack::Frame& b) {
  const Vector3d off = middle_of_hips(a.joint) - middle_of_hips(b.joint);
  double sum = 0.0;
  for (std::size_t i = 0; i < kJudgedCount; ++i) sum += (a.joint[i] - b.joint[i] - off).norm();
  return sum / kJudgedCount;
}

double jerk_of(const JudgedTrack& track, std::size_t from) {
  double sum = 0.0;
  for (std::size_t f = std::max<std::size_t>(from, 3); f < track.frames.size(); ++f)
    for (std::size_t i = 0; i < kJudgedCount; ++i) {
      const auto at = [&](std::size_t back) { return track.frames[f - back].joint[i]; };
      sum += (at(0) - 3.0 * at(1) + 3.0 * at(2) - at(3)).norm();
    }
  return sum;
}

// The shift with the least error, between frames by a parabola.
double lag_of_s(const JudgedTrack& track, const JudgedTrack& truth, std::size_t from, double hz) {
  constexpr int kMost = 6;
  std::array<double, 2 * kMost + 1> errors{};
  const auto n = static_cast<int>(track.frames.size());
  for (int late = -kMost; late <= kMost; ++late)
    for (int f = static_cast<int>(from) + kMost; f < n - kMost; ++f)
      errors[static_cast<std::size_t>(late + kMost)] +=
          relative_error(track.frames[static_cast<std::size_t>(f)],
                         truth.frames[static_cast<std::size_t>(f - late)]);
  const auto least = std::min_element(errors.begin() + 1, errors.end() - 1);
  const double bend = least[-1] - 2.0 * least[0] + least[1];
  const double between = bend > 0.0 ? 0.5 * (least[-1] - least[1]) / bend : 0.0;
  return (static_cast<double>(least - errors.begin()) - kMost + between) / hz;
}

SolveFigures figures_of(const JudgedTrack& track, const JudgedTrack& truth, std::size_t from,
                        double hz) {
  SolveFigures figures;
  const std::size_t n = track.frames.size();
  if (n <= from + 16) return figures;
  std::vector<double> slides, lows;
  double floor_m[2] = {1e9, 1e9};
  for (const auto& frame : truth.frames)
    for (std::size_t s = 0; s < 2; ++s) floor_m[s] = std::min(floor_m[s], frame.foot[s].y());
  double absolute = 0.0, relative = 0.0;
  int stood[2] = {0, 0};
  const int planted = static_cast<int>(std::ceil(kPlanted_s * hz));
  const auto back =
      std::min(from, static_cast<std::size_t>(std::max(1.0, std::round(kSpeedOver_s * hz))));
  double sum[8] = {}, squares[8] = {};
  for (std::size_t f = from; f < n; ++f) {
    const auto &a = track.frames[f], &b = truth.frames[f];
    relative += relative_error(a, b);
    for (std::size_t i = 0; i < kJudgedCount; ++i)
      absolute += (a.joint[i] - b.joint[i]).norm() / kJudgedCount;
    figures.wrong_knees += a.wrong_knees;
    figures.wrong_elbows += a.wrong_elbows;
    lows.push_back(-a.lowest_m);
    for (std::size_t i = 0; i < 8; ++i) {
      sum[i] += a.bone_m[i];
      squares[i] += a.bone_m[i] * a.bone_m[i];
    }
    for (std::size_t s = 0; s < 2; ++s) {
      ++stood[s];
      const Vector3d true_step = b.foot[s] - truth.frames[f - back].foot[s];
      if (true_step.norm() * hz > kStandsBelow * static_cast<double>(back) ||
          b.foot[s].y() > floor_m[s] + kStandsUnder_m)
        stood[s] = 0;
      if (stood[s] < planted) continue;
      Vector3d step = a.foot[s] - track.frames[f - 1].foot[s];
      step.y() = 0.0;
      slides.push_back(step.norm() * hz * 100.0);
    }
  }
  const auto count = static_cast<double>(n - from);
  figures.relative_mm = 1000.0 * relative / count;
  figures.absolute_mm = 1000.0 * absolute / count;
  figures.jerk_ratio = jerk_of(track, from) / std::max(1e-9, jerk_of(truth, from));
  for (const double s : slides) figures.slide_cm_s += s / static_cast<double>(slides.size());
  std::sort(slides.begin(), slides.end());
  std::sort(lows.begin(), lows.end());
  figures.slide_p95_cm_s = percentile<double>(slides, 0.95);
  figures.planted = slides.size();
  figures.below_mm = 1000.0 * std::max(0.0, percentile<double>(lows, 0.99));
  for (std::size_t i = 0; i < 8; ++i) {
    const double mean = sum[i] / count;
    figures.bone_percent =
        std::max(figures.bone_percent,
                 100.0 * std::sqrt(std::max(0.0, squares[i] / count - mean * mean)) / mean);
  }
  figures.lag_ms = 1000.0 * lag_of_s(track, truth, from, hz);
  return figures;
}

void add(SolveFigures& sum, const SolveFigures& f, double share) {
  sum.relative_mm += share * f.relative_mm;
  sum.absolute_mm += share * f.absolute_mm;
  sum.jerk_ratio += share * f.jerk_ratio;
  // Of all feet that stand alike: a take may have few.
  const double stood = static_cast<double>(f.planted),
               of_all = stood / std::max(1.0, stood + static_cast<double>(sum.planted));
  sum.slide_cm_s += of_all * (f.slide_cm_s - sum.slide_cm_s);
  sum.slide_p95_cm_s += of_all * (f.slide_p95_cm_s - sum.slide_p95_cm_s);
  sum.planted += f.planted;
  sum.below_mm += share * f.below_mm;
  sum.bone_percent = std::max(sum.bone_percent, f.bone_percent);
  sum.wrong_knees += f.wrong_knees;
  sum.wrong_elbows += f.wrong_elbows;
  sum.lag_ms += share * f.lag_ms;
}

}  // namespace

SolveScore evaluate_scene(const CaptureScene& scene, const SolverOptions& options,
                          Duration warm_up) {
  SolveScore score;
  const JudgedTrack truth = truth_of(scene), baseline = baseline_of(scene);
  const JudgedTrack solved = solved_of(scene, options, score);
  const auto from =
      std::max<std::size_t>(3, static_cast<std::size_t>(warm_up.as_seconds() * scene.hz));
  score.solver = figures_of(solved, truth, from, scene.hz);
  score.truth = figures_of(truth, truth, from, scene.hz);
  score.baseline = figures_of(baseline, truth, from, scene.hz);
  score.frames = scene.frames.size();
  return score;
}

SolveScore mean_of(const std::vector<SolveScore>& scores) {
  SolveScore mean;
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, scores.size()));
  for (const SolveScore& s : scores) {
    add(mean.solver, s.solver, share);
    add(mean.truth, s.truth, share);
    add(mean.baseline, s.baseline, share);
    mean.ns_per_frame += share * s.ns_per_frame;
    mean.camera_height_error_mm += share * std::abs(s.camera_height_error_mm);
    mean.camera_pitch_error_deg += share * std::abs(s.camera_pitch_error_deg);
    mean.height_error_percent += share * std::abs(s.height_error_percent);
    mean.refused += s.refused;
    mean.frames += s.frames;
  }
  return mean;
}

}  // namespace dance
