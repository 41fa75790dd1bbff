#include "research/capture/several_eval.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/pose/kinematics.h"
#include "core/program/figures.h"
#include "producers/camera/multiview/multi_view.h"
#include "research/capture/thread_time.h"
#include "testing/camera/limb_joints.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kFirstHz = 30.0;
// A network's time: a picture of the other camera is known so long after it was taken.
constexpr Duration kNetworkTime = Duration::ms(8);
// From when on is judged: both are placed, and weigh in fully.
constexpr double kJudgedAfter_s = 2.0;
// Where they never were placed, or from the same moment without them.
constexpr double kCoverEvery_s = 8.0, kCoverFor_s = 2.0;
// Of a length of adults, about what it is on average for their height.
constexpr double kLengthSd = 0.03;
constexpr double kDegrees = 57.29577951308232;
constexpr std::array kArm{Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky,
                          Landmark::kLeftIndex, Landmark::kLeftThumb};

// A body that differs from others as adults do: its height, and each length beside it. A solver
// that is told the height is told how tall it stands.
Skeleton dancer_of(std::uint64_t seed) {
  Random random(seed * 7919 + 13);
  const double height_m = random.uniform(1.55, 1.88);
  BodyLengths lengths = average_lengths(height_m);
  for (double& length : lengths) length *= std::exp(kLengthSd * random.normal());
  Skeleton skeleton = shape_of(lengths).skeleton;
  const auto neck = static_cast<float>(std::exp(kLengthSd * random.normal()));
  for (const Bone bone : {Bone::kNeck, Bone::kHead}) skeleton.offset_m[index_of(bone)] *= neck;
  skeleton.tip_m[static_cast<std::size_t>(Tip::kHead)] *=
      static_cast<float>(std::exp(kLengthSd * random.normal()));
  return skeleton;
}

// The same dance on it.
std::vector<Pose> danced_by(const Skeleton& skeleton, const CodecTake& take) {
  std::vector<Pose> poses = take.poses;
  const float by = skeleton.offset(Bone::kHips).y() / take.skeleton.offset(Bone::kHips).y();
  for (Pose& pose : poses) pose.p_WH_m *= by;
  return poses;
}

SeveralStage make_stage(const SeveralCase& what, const CodecTake& recorded, std::uint64_t seed) {
  CodecTake take = recorded;
  if (!what.keeps_bodies) {
    take.skeleton = dancer_of(seed);
    take.poses = danced_by(take.skeleton, recorded);
  }
  SeveralStage stage;
  SceneCamera camera;
  camera.distance_m = what.distance_m;
  SceneErrors errors = what.is_exact ? no_errors() : SceneErrors();
  // A network takes one person for smaller than another.
  if (!what.is_exact) errors.scale = Random(seed + 77).uniform(0.92, 1.08);
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(take.hz / kFirstHz)));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < take.poses.size(); i += every) poses.push_back(take.poses[i]);
  stage.first = make_scene(take.name, take.skeleton, poses, take.hz / static_cast<double>(every),
                           camera, errors, seed);
  SceneEye eye;
  eye.camera = camera;
  eye.camera.height_m = 1.5;
  eye.camera.pitch_rad = 0.16;
  eye.camera.roll_rad = -0.02;
  eye.around_rad = what.around_deg / kDegrees;
  eye.hz = what.hz;
  eye.later_s = 1e-3 * what.later_ms;
  eye.drift = 1e-3 * what.drift_ms_per_min / 60.0;
  eye.phase_s = std::fmod(0.011 + 0.0037 * static_cast<double>(seed % 9), 1.0 / what.hz);
  stage.other = make_eye(stage.first, take.skeleton, take.poses, take.hz, eye, errors, seed + 5000);
  if (!what.moves_second) return stage;
  eye.around_rad += 8.0 / kDegrees;
  eye.camera.pitch_rad += 0.05;
  stage.moved = make_eye(stage.first, take.skeleton, take.poses, take.hz, eye, errors, seed + 5000);
  stage.half_s = 0.5 * static_cast<double>(poses.size()) / stage.first.hz;
  return stage;
}

void hide_arm(BodyLandmarks& body) {
  for (const Landmark l : kArm) body.visibility[index_of(l)] = 0.1f;
}

bool is_covered(double since_s) {
  return since_s > kCoverEvery_s - kCoverFor_s &&
         std::fmod(since_s, kCoverEvery_s) > kCoverEvery_s - kCoverFor_s;
}

struct Sums {
  DepthErrors sum;
  std::vector<double> hips_mm, steps_mm;
  std::size_t frames = 0;
  void add(const LimbPlaces& got, const LimbPlaces& truth) {
    const Vector3d off = middle_of_hips(got) - middle_of_hips(truth);
    hips_mm.push_back(1e3 * std::abs(off.z()));
    for (std::size_t i = 0; i < got.size(); ++i) {
      const Vector3d error = got[i] - truth[i];
      const double share = 1e3 / static_cast<double>(got.size());
      sum.joints_mm += share * std::abs(error.z());
      sum.relative_mm += share * (error - off).norm();
      sum.absolute_mm += share * error.norm();
    }
    ++frames;
  }
  DepthErrors mean() {
    const double count = static_cast<double>(std::max<std::size_t>(1, frames));
    DepthErrors mean = sum;
    for (double* value : {&mean.joints_mm, &mean.relative_mm, &mean.absolute_mm}) *value /= count;
    for (const double mm : hips_mm) mean.hips_mm += mm / count;
    std::sort(hips_mm.begin(), hips_mm.end());
    std::sort(steps_mm.begin(), steps_mm.end());
    mean.hips_p95_mm = percentile<double>(hips_mm, 0.95);
    mean.step_p99_mm = percentile<double>(steps_mm, 0.99);
    return mean;
  }
};

// What a run found beside poses.
struct Found {
  std::vector<std::optional<LimbPlaces>> joints_C_m;  // of each picture
  std::vector<std::int64_t> ns;
  double settled_s = -1.0, again_s = -1.0;
  double turn_deg = 0.0, place_mm = 0.0, later_ms = 0.0;  // sums, of `placed_frames`
  std::size_t placed_frames = 0;
  int moves = 0;
};

void judge_placement(const SeveralStage& stage, const CameraPair& pair, double since_s,
                     Found& found) {
  const auto& placement = pair.placement();
  if (!placement) return;
  if (found.settled_s < 0.0) found.settled_s = since_s;
  if (since_s > stage.half_s && found.again_s < 0.0 && pair.moves() > 0)
    found.again_s = since_s - stage.half_s;
  if (since_s > stage.half_s && pair.moves() == 0) return;
  const EyeScene& eye = since_s > stage.half_s ? stage.moved : stage.other;
  const Matrix3d R_BA = eye.R_WC.transpose() * stage.first.R_WC;
  const Vector3d p_AB = stage.first.R_WC.transpose() * (eye.p_WC_m - stage.first.p_WC_m);
  const RelativePose& pose = placement->pose;
  found.turn_deg += kDegrees * Eigen::AngleAxisd(pose.R_BA * R_BA.transpose()).angle();
  found.place_mm += 1e3 * (placement->p_AB_m() - p_AB).norm();
  found.later_ms += 1e3 * std::abs(pose.later_s - eye.later_s(since_s));
  ++found.placed_frames;
}

Found run_stage(const SeveralStage& stage, const SeveralCase& what, bool has_two, bool is_told,
                double placed_s) {
  SolverOptions options;
  if (is_told) options.height_m = stage.first.height_m;
  const Pinhole& lens = stage.first.camera.pinhole;
  BodySolver solver(options, lens);
  MultiView views(lens);
  if (has_two) views.add_camera(stage.other.eye.camera.pinhole);
  Found found;
  Pose pose;
  BodyFrames frames;
  std::size_t next = 0;
  for (std::size_t f = 0; f < stage.first.frames.size(); ++f) {
    BodyLandmarks body = stage.first.frames[f].landmarks;
    const MonoTime now = body.capture_time;
    const double since_s = static_cast<double>(f) / stage.first.hz;
    const double cover_s = placed_s < 0.0 ? -1.0 : since_s - placed_s;
    const bool is_covered_now = is_covered(cover_s);
    if (what.hides_arm && std::fmod(since_s, 4.0) < 2.0) hide_arm(body);
    if (what.covers_first && is_covered_now) {
      body = BodyLandmarks();
      body.capture_time = now;
    }
    const std::int64_t begin_ns = thread_time_ns();
    const EyeScene& eye = since_s > stage.half_s ? stage.moved : stage.other;
    for (; has_two && next < eye.moments.size() && eye.moments[next].time + kNetworkTime <= now;
         ++next) {
      if (what.covers_second && is_covered_now) continue;
      views.see_other(0, eye.moments[next].landmarks);
    }
    OtherViews others;
    if (has_two) {
      others = views.see_first(body, {options.height_m, solver.height_m()});
      if (const auto lengths = views.take_lengths()) solver.take_lengths(*lengths);
    }
    const bool is_there = solver.solve(body, {}, pose, others);
    found.ns.push_back(thread_time_ns() - begin_ns);
    found.joints_C_m.emplace_back();
    if (has_two) judge_placement(stage, views.pair(0), since_s, found);
    if (!is_there) continue;
    forward_kinematics(solver.skeleton(), pose, frames);
    const CameraStand stand = solver.camera_stand();
    LimbPlaces joints = limb_places(frames);
    for (Vector3d& joint : joints) joint = stand.R_WC.transpose() * (joint - stand.p_WC_m);
    found.joints_C_m.back() = joints;
  }
  if (has_two) found.moves = views.pair(0).moves();
  return found;
}

LimbPlaces truth_of(const SeveralStage& stage, std::size_t f) {
  LimbPlaces joints;
  for (std::size_t i = 0; i < joints.size(); ++i)
    joints[i] =
        stage.first.R_WC.transpose() *
        (stage.first.frames[f].truth_W_m[index_of(kLimbJoints[i].landmark)] - stage.first.p_WC_m);
  return joints;
}

void judge_run(const SeveralStage& stage, const SeveralCase& what, const Found& found,
               double from_s, double placed_s, Sums& sums) {
  for (std::size_t f = 1; f < found.joints_C_m.size(); ++f) {
    const double since_s = static_cast<double>(f) / stage.first.hz;
    if (since_s < from_s || !found.joints_C_m[f]) continue;
    // Of covered eyes, what happens while they are, and just after.
    if ((what.covers_first || what.covers_second) && !is_covered(since_s - placed_s) &&
        !is_covered(since_s - placed_s - 0.5))
      continue;
    if (what.hides_arm && std::fmod(since_s, 4.0) > 2.0) continue;
    const LimbPlaces truth = truth_of(stage, f);
    sums.add(*found.joints_C_m[f], truth);
    if (!found.joints_C_m[f - 1]) continue;
    const Vector3d way = middle_of_hips(*found.joints_C_m[f]) -
                         middle_of_hips(*found.joints_C_m[f - 1]) -
                         (middle_of_hips(truth) - middle_of_hips(truth_of(stage, f - 1)));
    sums.steps_mm.push_back(1e3 * way.norm());
  }
}

double mean_us(const std::vector<std::int64_t>& ns) {
  double sum = 0.0;
  for (const std::int64_t one : ns) sum += 1e-3 * static_cast<double>(one);
  return ns.empty() ? 0.0 : sum / static_cast<double>(ns.size());
}

}  // namespace

const char* name_of(SeenBy how) {
  switch (how) {
    case SeenBy::kOne:
      return "one camera";
    case SeenBy::kOneTold:
      return "one camera, height told";
    case SeenBy::kTwo:
      return "two cameras";
    case SeenBy::kTwoTold:
      return "two cameras, height told";
  }
  return "";
}

std::vector<SeveralCase> several_cases() {
  std::vector<SeveralCase> cases(10);
  cases[0] = {"60 degrees apart", 60.0};
  cases[1] = {"15 degrees apart", 15.0};
  cases[2] = {"30 degrees apart", 30.0};
  cases[3] = {"90 degrees apart", 90.0};
  cases[4] = {"stamps 40 ms late, and 3 ms more a minute", 60.0};
  cases[4].later_ms = 40.0;
  cases[4].drift_ms_per_min = 3.0;
  cases[5] = {"the second at 15 Hz", 60.0};
  cases[5].hz = 15.0;
  cases[6] = {"left arm hidden from the first", 60.0};
  cases[6].hides_arm = true;
  cases[7] = {"the first covered for 2 s", 60.0};
  cases[7].covers_first = true;
  cases[8] = {"the second covered for 2 s", 60.0};
  cases[8].covers_second = true;
  cases[9] = {"the second moved half-way", 60.0};
  cases[9].moves_second = true;
  return cases;
}

SeveralScore evaluate_several(const SeveralCase& what, const std::vector<CodecTake>& takes) {
  std::vector<SeveralStage> stages;
  for (std::size_t i = 0; i < takes.size(); ++i)
    stages.push_back(make_stage(what, takes[i], 1000 + i));
  return evaluate_stages(what, stages);
}

SeveralScore evaluate_stages(const SeveralCase& what, const std::vector<SeveralStage>& stages) {
  SeveralScore score;
  score.what = what;
  std::array<Sums, kSeenByCount> sums;
  double settled_s = 0.0, again_s = 0.0, turn = 0.0, place = 0.0, later = 0.0;
  std::size_t placed_frames = 0;
  int again = 0;
  for (const SeveralStage& stage : stages) {
    ++score.takes;
    SeveralCase clear = what;
    clear.covers_first = clear.covers_second = false;
    const bool has_cover = what.covers_first || what.covers_second;
    Found told = run_stage(stage, clear, true, true, -1.0);
    if (told.settled_s < 0.0) continue;
    const double placed_s = told.settled_s;
    if (has_cover) told = run_stage(stage, what, true, true, placed_s);
    const Found untold = run_stage(stage, what, true, false, placed_s);
    const Found one = run_stage(stage, what, false, false, placed_s),
                one_told = run_stage(stage, what, false, true, placed_s);
    ++score.placed;
    const std::array<const Found*, kSeenByCount> all{&one, &one_told, &untold, &told};
    for (std::size_t w = 0; w < kSeenByCount; ++w)
      judge_run(stage, what, *all[w], placed_s + kJudgedAfter_s, placed_s, sums[w]);
    settled_s += placed_s;
    if (told.again_s >= 0.0) {
      again_s += told.again_s;
      ++again;
    }
    turn += told.turn_deg;
    place += told.place_mm;
    later += told.later_ms;
    placed_frames += told.placed_frames;
    score.moves += told.moves;
    score.us_per_picture += mean_us(told.ns) - mean_us(one_told.ns);
  }
  for (std::size_t w = 0; w < kSeenByCount; ++w) score.errors[w] = sums[w].mean();
  score.frames = sums[3].frames;
  if (score.placed > 0) {
    score.settled_s = settled_s / score.placed;
    score.us_per_picture /= score.placed;
  }
  if (again > 0) score.again_s = again_s / again;
  if (placed_frames > 0) {
    const auto count = static_cast<double>(placed_frames);
    score.turn_error_deg = turn / count;
    score.place_error_mm = place / count;
    score.later_error_ms = later / count;
  }
  return score;
}

}  // namespace dance
