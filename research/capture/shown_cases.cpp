#include "research/capture/shown_cases.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/pose/skeleton.h"
#include "producers/camera/solver/body_fit.h"

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr double kStill_s = 14.0, kStill_hz = 30.0;

// Scenes of one row, one at a time.
class ShownRowMaker {
 public:
  ShownRowMaker(std::string name, const SolverOptions& options) : options_(options) {
    row_.name = std::move(name);
  }
  void add(const CaptureScene& scene) {
    const ShownTrack truth = truth_track(scene);
    for (const ShownFrame& frame : truth.frames) row_.flipped += frame.is_flipped ? 1 : 0;
    truths_.push_back(shown_figures(truth, truth));
    befores_.push_back(shown_figures(shown_track(scene, without_corrections(options_)), truth));
    nows_.push_back(shown_figures(shown_track(scene, options_), truth));
  }
  ShownRow finish() && {
    row_.truth = all_of(truths_);
    row_.before = all_of(befores_);
    row_.now = all_of(nows_);
    return std::move(row_);
  }

 private:
  SolverOptions options_;
  ShownRow row_;
  std::vector<ShownFigures> truths_, befores_, nows_;
};

ShownRow takes_row(std::string name, const std::vector<CodecTake>& takes, const SceneCamera& camera,
                   const SceneErrors& errors, const SolverOptions& options, int sides) {
  ShownRowMaker row(std::move(name), options);
  for (std::size_t i = 0; i < takes.size(); ++i)
    for (int side = 0; side < sides; ++side)
      row.add(make_scene(takes[i].name, takes[i].skeleton,
                         turned_poses(takes[i].poses, 2.0 * std::numbers::pi * side / sides),
                         takes[i].hz, camera, errors,
                         2000 + 10 * i + static_cast<std::size_t>(side)));
  return std::move(row).finish();
}

ShownRow still_row(std::string name, const SceneCamera& camera, const SceneErrors& errors,
                   const SolverOptions& options, std::size_t postures) {
  ShownRowMaker row(std::move(name), options);
  for (std::size_t which = 0; which < postures; ++which)
    for (int side = 0; side < 2; ++side) {
      const std::vector<Pose> poses(static_cast<std::size_t>(kStill_s * kStill_hz),
                                    still_posture(which));
      row.add(make_scene("still", average_skeleton(), turned_poses(poses, 0.7 * side), kStill_hz,
                         camera, errors, 3000 + 10 * which + static_cast<std::size_t>(side)));
    }
  return std::move(row).finish();
}

std::string soles_text(const SoleFigures& s) {
  return fmt::format(" {:>5.1f} {:>5.1f} {:>6.1f}", s.over_5_percent, s.over_20_percent,
                     std::max(0.0, s.worst_mm));
}

std::string lag_text(const std::optional<double>& lag_ms) {
  return lag_ms ? fmt::format("{:.1f}", *lag_ms) : "-";
}

std::string line_text(const char* name, const ShownFigures& f) {
  return fmt::format(
      "  {:<8}{}{} {:>7.1f} {:>6.0f} {:>6.0f} {:>5} {:>6.1f} {:>6} {:>6.1f} {:>6.1f} {:>6} "
      "{:>6.1f} {:>6.1f}\n",
      name, soles_text(f.soles), soles_text(f.start_soles), f.soles.lift_p99_mm, f.fastest_deg_s,
      f.most_deg, f.flips, f.facing_error_deg, lag_text(f.facing_lag_ms), f.hand_p50_mm,
      f.hand_p99_mm, lag_text(f.hand_lag_ms), f.wrist_error_mm, f.wrist_error_p95_mm);
}

}  // namespace

SolverOptions without_corrections(SolverOptions options) {
  options.keeps_above_floor = options.limits_facing = options.steadies_hands = false;
  return options;
}

std::vector<Pose> turned_poses(const std::vector<Pose>& poses, double angle_rad) {
  const Eigen::Quaternionf R(
      Eigen::AngleAxisf(static_cast<float>(angle_rad), Eigen::Vector3f::UnitY()));
  std::vector<Pose> turned = poses;
  for (Pose& pose : turned) {
    pose.p_WH_m = R * pose.p_WH_m;
    pose.R_PB[0] = (R * pose.R_PB[0]).normalized();
  }
  return turned;
}

Pose still_posture(std::size_t which) {
  // Of the upper arm, down, forward and turned; of the elbow.
  constexpr double kArms[kStillPostures][3]{
      {-1.35, 0.0, 0.2}, {-1.2, -0.5, 1.5}, {-0.1, -0.3, 0.3}, {0.9, -0.4, 0.6}};
  BodyState state = state_at_ease();
  for (std::size_t s = 0; s < 2; ++s) {
    const double sign = s == 0 ? 1.0 : -1.0;
    state.sides[s].upper_arm = turn_of(Vector3d(0.0, 0.0, sign * kArms[which][0])) *
                               turn_of(Vector3d(0.0, sign * kArms[which][1], 0.0));
    state.sides[s].elbow = kArms[which][2];
    state.sides[s].knee = 0.0;
  }
  Pose pose;
  write_pose(state, pose);
  pose.p_WH_m.y() = average_skeleton().offset(Bone::kHips).y();
  return pose;
}

std::vector<ShownRow> shown_rows(const std::vector<CodecTake>& takes, const SceneCamera& camera,
                                 const SolverOptions& options, const ShownScenes& scenes) {
  std::vector<ShownRow> rows;
  if (!takes.empty()) {
    rows.push_back(
        takes_row("from all sides", takes, camera, SceneErrors(), options, scenes.sides));
    SceneErrors flips;
    flips.flips_per_s = 1.0;
    rows.push_back(
        takes_row("backs taken for fronts", takes, camera, flips, options, scenes.sides));
    SceneErrors lasting = flips;
    lasting.flips_per_s = 0.5;
    lasting.flip_for_s = lasting.flip_most_s = 1.5;
    rows.push_back(
        takes_row("the same for 1.5 s each", takes, camera, lasting, options, scenes.sides));
    SceneErrors outside;
    outside.hides_outside = true;
    SceneCamera near = camera;
    near.distance_m = 1.9;
    near.height_m = 1.3;
    near.pitch_rad = 0.0;
    rows.push_back(
        takes_row("legs out of the picture", takes, near, outside, options, scenes.sides));
  }
  SceneErrors seen;
  seen.hidden_per_s = 0.0;
  rows.push_back(still_row("standing still", camera, seen, options, scenes.postures));
  rows.push_back(still_row("standing still, arms hidden now and then", camera, SceneErrors(),
                           options, scenes.postures));
  return rows;
}

ShownRow shown_row(const std::string& name, std::span<const BodyLandmarks> landmarks, double hz,
                   const Pinhole& camera, const SolverOptions& options) {
  ShownRow row;
  row.name = name;
  row.before =
      shown_figures(shown_track(landmarks, hz, camera, without_corrections(options)), {hz, {}});
  row.now = shown_figures(shown_track(landmarks, hz, camera, options), {hz, {}});
  return row;
}

std::string shown_table(const std::vector<ShownRow>& rows) {
  std::string text = fmt::format("{:<10} {:^18} {:^18} {:>7} {:^27} {:>6} {:^20} {:^13}\n", "",
                                 "soles below floor", "in the first 1.5 s", "above", "facing", "",
                                 "hands", "wrists off");
  for (const auto& cells : {
           std::array{"", ">5", ">20", "worst", ">5", ">20", "worst", "p99", "max", "frame",
                      "flips", "p95", "lag", "p50", "p99", "lag", "mean", "p95"},
           std::array{"", "%", "%", "mm", "%", "%", "mm", "mm", "deg/s", "deg", "", "deg", "ms",
                      "mm", "mm", "ms", "mm", "mm"},
       }) {
    constexpr std::array kWidths{10, 5, 5, 6, 5, 5, 6, 7, 6, 6, 5, 6, 6, 6, 6, 6, 6, 6};
    for (std::size_t i = 0; i < cells.size(); ++i)
      text += fmt::format("{}{:>{}}", i > 0 ? " " : "", cells[i], kWidths[i]);
    text += "\n";
  }
  for (const ShownRow& row : rows) {
    text += fmt::format("{} ({} frames", row.name, row.now.frames);
    if (row.flipped > 0) text += fmt::format(", {} of them flipped", row.flipped);
    if (row.now.without_pose > 0) text += fmt::format(", {} without a pose", row.now.without_pose);
    text += ")\n";
    if (row.truth.frames > 0) text += line_text("truth", row.truth);
    text += line_text("uncorr.", row.before) + line_text("shown", row.now);
  }
  return text;
}

}  // namespace dance
