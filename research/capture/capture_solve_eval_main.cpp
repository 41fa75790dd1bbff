// dance capture solve eval: the camera's solver on recorded dances, whose truth is known.
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/program/command_line.h"
#include "core/program/figures.h"
#include "core/program/program.h"
#include "research/capture/capture_solve_eval.h"
#include "research/capture/shown_cases.h"
#include "research/capture/shown_videos.h"
#include "research/codec_takes.h"

namespace dance {
namespace {

constexpr const char* kSolveExamples = R"(Examples:
  dance capture solve eval salsa.bvh
  dance capture solve eval *.bvh.xz --each
  dance capture solve eval salsa.bvh --told-height --json
  dance capture solve eval salsa.bvh --exact
  dance capture solve eval *.bvh.xz --shown
  dance capture solve eval dance.mp4 --shown --still 100
  relative   joints (shoulders, elbows, wrists, hips, knees, ankles) against the truth, the
             middle of the hips removed
  absolute   the same on the stage; the baseline knows the true camera
  jerk       third differences, the truth has 1
  slide      of feet that have stood for 0.1 s (slower than 10 cm/s), mean and 95 of 100 frames
  below      a sole below the floor, 99 of 100 frames are better
  bones      how much a bone's length changes
With --shown, what an audience sees from the first picture on, without what corrects it last and
with it: of takes turned to all four sides, of the same before a network that takes backs for
fronts, with the legs out of the picture, of persons who stand still; and of videos before the
real network.
  soles      frames with a heel, ball or toes more than 5 and 20 mm below the floor
  above      the lower sole above the floor, 99 of 100 frames are lower
  facing     the fastest turn, the largest in one frame, how often it became more than 90 degrees
             wrong (without a truth: turned by more within 0.2 s), 95 of 100 errors, lag of turns
  hands      movement of wrists from frame to frame; lag of those faster than 0.3 m/s
  wrists off of wrists against the truth, the middle of the hips removed, mean and 95 of 100
)";

constexpr std::size_t kStillFrames = 300;
// Of a webcam in a living room, in levels of 255.
constexpr double kSensorNoise = 3.0;

struct Wishes {
  std::vector<std::string> files;
  double hz = 30.0;
  double warm_up_s = 6.0;
  double smooth = 1.0;
  double camera_height_m = 1.2;
  double camera_pitch_deg = 5.0;
  double distance_m = 3.6;
  bool told_height = false;
  bool is_exact = false;
  bool no_feet = false;
  bool each = false;
  bool is_json = false;
  bool shown = false;
  bool uncorrected = false;
  std::uint64_t still = 0;
};

bool is_video(const std::string& path) {
  for (const std::string end : {".mp4", ".mkv", ".avi", ".mov", ".webm"})
    if (path.size() > end.size() && path.ends_with(end)) return true;
  return false;
}

nlohmann::ordered_json json_of(const SoleFigures& s) {
  return {{"over_5_mm_percent", rounded(s.over_5_percent, 100.0)},
          {"over_20_mm_percent", rounded(s.over_20_percent, 100.0)},
          {"worst_mm", rounded(std::max(0.0, s.worst_mm), 10.0)},
          {"above_p99_mm", rounded(s.lift_p99_mm, 10.0)}};
}

nlohmann::ordered_json lag_json(const std::optional<double>& lag_ms) {
  return lag_ms ? nlohmann::ordered_json(rounded(*lag_ms, 10.0)) : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of(const ShownFigures& f) {
  return {{"soles_below_floor", json_of(f.soles)},
          {"soles_below_floor_in_first_1_5_s", json_of(f.start_soles)},
          {"facing_fastest_deg_s", rounded(f.fastest_deg_s, 1.0)},
          {"facing_most_deg_in_frame", rounded(f.most_deg, 10.0)},
          {"facing_flips", f.flips},
          {"facing_error_p95_deg", rounded(f.facing_error_deg, 10.0)},
          {"facing_lag_ms", lag_json(f.facing_lag_ms)},
          {"hands_p50_mm", rounded(f.hand_p50_mm, 100.0)},
          {"hands_p99_mm", rounded(f.hand_p99_mm, 100.0)},
          {"hands_lag_ms", lag_json(f.hand_lag_ms)},
          {"wrist_error_mm", rounded(f.wrist_error_mm, 10.0)},
          {"wrist_error_p95_mm", rounded(f.wrist_error_p95_mm, 10.0)},
          {"frames", f.frames},
          {"frames_without_pose", f.without_pose}};
}

nlohmann::ordered_json shown_json(const std::vector<ShownRow>& rows) {
  nlohmann::ordered_json all;
  for (const ShownRow& row : rows) {
    nlohmann::ordered_json one{{"name", row.name}, {"flipped_frames", row.flipped}};
    if (row.truth.frames > 0) one["truth"] = json_of(row.truth);
    one["uncorrected"] = json_of(row.before);
    one["shown"] = json_of(row.now);
    all.push_back(std::move(one));
  }
  return all;
}

Result<void> show(const Wishes& wishes, const SceneCamera& camera, const SolverOptions& options) {
  std::vector<std::string> takes, videos;
  for (const std::string& file : wishes.files) (is_video(file) ? videos : takes).push_back(file);
  std::vector<CodecTake> dances;
  if (!takes.empty()) {
    DANCE_TRY(dances, load_codec_takes(takes, wishes.hz));
  }
  std::vector<ShownRow> rows;
  if (!dances.empty()) rows = shown_rows(dances, camera, options);
  for (const std::string& path : videos) {
    DANCE_TRY(const VideoLandmarks video, video_landmarks(path));
    rows.push_back(
        shown_row(path + ", real network", video.frames, video.hz, video.camera, options));
    if (wishes.still == 0) continue;
    DANCE_TRY(const VideoLandmarks still,
              still_landmarks(path, wishes.still, kStillFrames, kSensorNoise));
    rows.push_back(shown_row(fmt::format("{}, frame {} held still", path, wishes.still),
                             still.frames, still.hz, still.camera, options));
  }
  const std::string text = wishes.is_json ? shown_json(rows).dump(2) + "\n" : shown_table(rows);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

std::string line_of(const std::string& name, const SolveFigures& f) {
  return fmt::format(
      "{:<34} {:>8.1f} {:>8.1f} {:>6.2f} {:>6.1f} {:>6.1f} {:>6.1f} {:>6.2f} {:>6} {:>6} "
      "{:>6.1f}\n",
      name, f.relative_mm, f.absolute_mm, f.jerk_ratio, f.slide_cm_s, f.slide_p95_cm_s, f.below_mm,
      f.bone_percent, f.wrong_knees, f.wrong_elbows, f.lag_ms);
}

std::string table_of(const std::string& name, const SolveScore& s) {
  return fmt::format("{} ({} frames)\n", name, s.frames) + line_of("  truth", s.truth) +
         line_of("  network alone", s.baseline) + line_of("  solver", s.solver) +
         fmt::format(
             "  camera off by {:.0f} mm and {:.1f} deg, dancer's height by {:.1f} %, {} frames "
             "without a pose, {:.0f} us a frame\n",
             s.camera_height_error_mm, s.camera_pitch_error_deg, s.height_error_percent, s.refused,
             s.ns_per_frame / 1000.0);
}

nlohmann::ordered_json json_of(const SolveFigures& f) {
  return {{"relative_mm", rounded(f.relative_mm, 100.0)},
          {"absolute_mm", rounded(f.absolute_mm, 100.0)},
          {"jerk_ratio", rounded(f.jerk_ratio, 1000.0)},
          {"foot_slide_cm_s", rounded(f.slide_cm_s, 100.0)},
          {"foot_slide_p95_cm_s", rounded(f.slide_p95_cm_s, 100.0)},
          {"below_floor_mm", rounded(f.below_mm, 100.0)},
          {"bone_length_change_percent", rounded(f.bone_percent, 1000.0)},
          {"wrong_knees", f.wrong_knees},
          {"wrong_elbows", f.wrong_elbows},
          {"lag_ms", rounded(f.lag_ms, 10.0)}};
}

Result<void> run(const Wishes& wishes) {
  if (!(wishes.hz >= 10.0 && wishes.hz <= 120.0)) return fail("--hz must lie between 10 and 120");
  SceneCamera camera;
  camera.height_m = wishes.camera_height_m;
  camera.pitch_rad = wishes.camera_pitch_deg / 57.29577951;
  camera.distance_m = wishes.distance_m;
  SolverOptions options;
  options.smooth = wishes.smooth;
  options.holds_feet = !wishes.no_feet;
  if (wishes.uncorrected) options = without_corrections(options);
  if (wishes.shown) return show(wishes, camera, options);
  DANCE_TRY(const std::vector<CodecTake> takes, load_codec_takes(wishes.files, wishes.hz));
  std::vector<SolveScore> scores;
  std::string text;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const CodecTake& take = takes[i];
    const CaptureScene scene = make_scene(take.name, take.skeleton, take.poses, take.hz, camera,
                                          wishes.is_exact ? no_errors() : SceneErrors(), 1000 + i);
    if (wishes.told_height) options.height_m = scene.height_m;
    scores.push_back(evaluate_scene(scene, options, Duration::seconds(wishes.warm_up_s)));
    if (wishes.each) text += table_of(take.name, scores.back());
  }
  const SolveScore mean = mean_of(scores);
  if (wishes.is_json) {
    const nlohmann::ordered_json report{
        {"takes", takes.size()},
        {"frames", mean.frames},
        {"solver", json_of(mean.solver)},
        {"truth", json_of(mean.truth)},
        {"baseline_network_alone", json_of(mean.baseline)},
        {"camera_height_error_mm", rounded(mean.camera_height_error_mm, 10.0)},
        {"camera_pitch_error_deg", rounded(mean.camera_pitch_error_deg, 100.0)},
        {"dancer_height_error_percent", rounded(mean.height_error_percent, 100.0)},
        {"frames_without_pose", mean.refused},
        {"ns_per_frame", rounded(mean.ns_per_frame, 1.0)}};
    std::printf("%s\n", report.dump(2).c_str());
    return {};
  }
  text = fmt::format("{:<34} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}\n", "",
                     "relative", "absolute", "jerk", "slide", "p95", "below", "bones", "wrong",
                     "wrong", "lag") +
         fmt::format("{:<34} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}\n", "",
                     "mm", "mm", "ratio", "cm/s", "cm/s", "mm", "%", "knees", "elbows", "ms") +
         text + table_of(fmt::format("{} takes", takes.size()), mean);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line(
      "The camera's solver on recorded dances before a simulated camera, beside the network alone.",
      "dance capture solve eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz; with --shown videos too")
      .required();
  line.add("--hz", wishes.hz, "pictures a second").shows_default();
  line.add("--warm-up", wishes.warm_up_s, "seconds from the begin that are not judged")
      .shows_default();
  line.add("--smooth", wishes.smooth, "the solver's smoothing").shows_default();
  line.add("--camera-height", wishes.camera_height_m, "metres over the floor").shows_default();
  line.add("--camera-pitch", wishes.camera_pitch_deg, "degrees that it looks down").shows_default();
  line.add("--distance", wishes.distance_m, "metres from the camera to the middle of the dance")
      .shows_default();
  line.add_flag("--told-height", wishes.told_height, "the solver is told how tall the dancer is");
  line.add_flag("--exact", wishes.is_exact, "a network without errors");
  line.add_flag("--free-feet", wishes.no_feet, "feet that stand are not held");
  line.add_flag("--uncorrected", wishes.uncorrected,
                "without what corrects the shown pose last: floor, facing, hands");
  line.add_flag("--shown", wishes.shown, "judges what an audience sees, see below");
  line.add("--still", wishes.still, "with --shown: this frame of a video, held still for 10 s too")
      .range(1, 1000000);
  line.add_flag("--each", wishes.each, "each take too");
  line.add_flag("--json", wishes.is_json, "one JSON object on stdout");
  line.footer(dance::kSolveExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
