#include "research/trackers/trackers_eval.h"

#include <algorithm>
#include <cmath>

#include "core/pose/heading.h"
#include "core/pose/interpolate.h"
#include "core/program/figures.h"
#include "research/capture/thread_time.h"
#include "research/in_two_threads.h"
#include "research/trackers/worn_devices.h"
#include "testing/motion/motion_measures.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr double kStands_s = 1.3, kBegins_s = 0.8, kSkipped_s = 0.5, kDanced_s = 10.0;
constexpr double kLost_s = 1.0, kLostMargin_s = 2.0;
constexpr float kSway_m = 0.006f;
constexpr double kPerRadian = 180.0 / 3.14159265358979;

// A dancer of a take, its body and its devices.
struct Dancer {
  PredictTake truth;
  WornDevices devices;
  Random random;
};

std::uint64_t seed_of(const std::string& name, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ seed;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

Dancer dancer_of(const PredictTake& take, int points, const TrackerEvalOptions& options) {
  Random random(seed_of(take.name, options.seed));
  const float height = dancer_height_m(take) * (1.0f + 0.02f * static_cast<float>(random.normal()));
  const Skeleton body = human_skeleton(height, 0.03f, random);
  const std::uint64_t worn = random.next_u64();
  return {at_rate(on_body(take, body), options.hz), WornDevices(body, point_set(points), worn),
          random};
}

// Before the dance: a T-pose, and the way into the first pose.
std::vector<Pose> before_the_dance(Dancer& dancer, double hz) {
  const Pose& first = dancer.truth.poses.front();
  const Pose stands =
      human_t_pose(dancer.truth.skeleton, first.p_WH_m, heading_rad(first.R_PB[0]), dancer.random);
  const auto standing = static_cast<std::size_t>(kStands_s * hz);
  const auto beginning = static_cast<std::size_t>(kBegins_s * hz);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < standing + beginning; ++i) {
    const auto t = static_cast<float>(static_cast<double>(i) / hz);
    const float part =
        i < standing ? 0.0f : static_cast<float>(i - standing) / static_cast<float>(beginning);
    Pose pose = interpolate(stands, first, part * part * (3.0f - 2.0f * part));
    pose.p_WH_m += kSway_m * (1.0f - part) * Vector3f(std::sin(2.0f * t), 0.0f, std::sin(1.3f * t));
    normalize(pose);
    poses.push_back(pose);
  }
  return poses;
}

struct Solved {
  std::vector<Pose> poses;
  std::vector<double> times_us;
  Skeleton skeleton;
};

struct LostPoint {
  TrackedPoint point = TrackedPoint::kLeftHand;
  std::size_t from = 0, to = 0;
};

Solved solve_take(Dancer& dancer, const TrackerTrial& trial, const TrackerEvalOptions& options,
                  const LostPoint& lost) {
  TrackerBody body({.guide = trial.guide, .model = options.model});
  MonoTime time = MonoTime() + Duration::s(1);
  const Duration step = Duration::period_of_hz(options.hz);
  Solved solved;
  const auto solve = [&](Pose truth, bool is_lost) {
    truth.capture_time = time;
    time += step;
    TrackerFrame frame = dancer.devices.see(truth, options.hz);
    if (is_lost) frame.remove(lost.point);
    Pose pose;
    const std::int64_t began = thread_time_ns();
    body.solve(frame, pose);
    solved.times_us.push_back(static_cast<double>(thread_time_ns() - began) * 1e-3);
    return pose;
  };
  if (trial.start == TrackerStart::kTPose)
    for (const Pose& pose : before_the_dance(dancer, options.hz)) solve(pose, false);
  solved.times_us.clear();
  for (std::size_t i = 0; i < dancer.truth.poses.size(); ++i)
    solved.poses.push_back(solve(dancer.truth.poses[i], i >= lost.from && i < lost.to));
  solved.skeleton = body.skeleton();
  return solved;
}

// In the fastest turn of the hips.
LostPoint lost_in_turn(const PredictTake& truth, int points) {
  LostPoint lost;
  lost.point = points == 3   ? TrackedPoint::kLeftHand
               : points == 4 ? TrackedPoint::kHips
                             : TrackedPoint::kLeftFoot;
  const auto frames_of = [&](double s) { return static_cast<std::size_t>(s * truth.hz); };
  const std::size_t margin = frames_of(kLostMargin_s), half = frames_of(0.25);
  float fastest = -1.0f;
  std::size_t at = margin;
  for (std::size_t i = margin; i + margin + frames_of(kLost_s) < truth.poses.size(); ++i) {
    const float turn = std::abs(std::remainder(
        heading_rad(truth.poses[i + half].R_PB[0]) - heading_rad(truth.poses[i - half].R_PB[0]),
        6.2831853f));
    if (turn > fastest) fastest = turn, at = i;
  }
  lost.from = at - frames_of(0.3);
  lost.to = lost.from + frames_of(kLost_s);
  return lost;
}

void judge_places(const PredictTake& truth, const Solved& solved, std::size_t first,
                  TrackerScore& score) {
  BodyFrames is, was, known;
  for (std::size_t i = first; i < truth.poses.size(); ++i) {
    const Pose& pose = truth.poses[i];
    forward_kinematics(truth.skeleton, pose, was);
    forward_kinematics(solved.skeleton, solved.poses[i], is);
    forward_kinematics(solved.skeleton, pose, known);
    const Vector3f hips = is.p_WB_m[0] - was.p_WB_m[0];
    const Vector3f head = was.position(Bone::kHead) - known.position(Bone::kHead);
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const double joints = static_cast<double>((is.p_WB_m[b] - was.p_WB_m[b]).norm());
      score.joints_m += joints / kBoneCount;
      score.body_m +=
          static_cast<double>((is.p_WB_m[b] - was.p_WB_m[b] - hips).norm()) / kBoneCount;
      score.proportions_m +=
          static_cast<double>((known.p_WB_m[b] + head - was.p_WB_m[b]).norm()) / kBoneCount;
      score.turns_deg += kPerRadian / kBoneCount *
                         static_cast<double>(pose.R_PB[b].angularDistance(solved.poses[i].R_PB[b]));
    }
    score.hips_m += static_cast<double>(hips.norm());
    ++score.frames;
  }
}

void judge_motion(const PredictTake& truth, const Solved& solved, std::size_t first,
                  TrackerScore& score) {
  const std::span<const Pose> true_poses(truth.poses), poses(solved.poses);
  const JointTrack danced(truth.skeleton, true_poses.subspan(first), truth.hz);
  const JointTrack shown(solved.skeleton, poses.subspan(first), truth.hz);
  const Stance stance = stance_of(danced);
  score.slide_m_s = slide_m_s(shown, stance);
  score.true_slide_m_s = slide_m_s(danced, stance);
  score.jerk_ratio = jerk_m_s3(shown, Places::kWorld) / jerk_m_s3(danced, Places::kWorld);
}

void judge_lost(const PredictTake& truth, const Solved& solved, const LostPoint& lost,
                TrackerScore& score) {
  BodyFrames is, was, is_before, was_before;
  const std::size_t bone = index_of(kPointBones[index_of(lost.point)]);
  for (std::size_t i = lost.from - 1; i < lost.to + static_cast<std::size_t>(truth.hz / 2); ++i) {
    forward_kinematics(truth.skeleton, truth.poses[i], was);
    forward_kinematics(solved.skeleton, solved.poses[i], is);
    if (i >= lost.from && i < lost.to)
      score.lost_m += static_cast<double>((is.p_WB_m[bone] - was.p_WB_m[bone]).norm()) /
                      static_cast<double>(lost.to - lost.from);
    if (i >= lost.from)
      for (std::size_t b = 0; b < kBoneCount; ++b) {
        const float shown = (is.p_WB_m[b] - is_before.p_WB_m[b]).norm();
        const float danced = (was.p_WB_m[b] - was_before.p_WB_m[b]).norm();
        score.lost_jump_m = std::max(score.lost_jump_m, static_cast<double>(shown - danced));
      }
    is_before = is;
    was_before = was;
  }
}

}  // namespace

TrackerScore judge_trackers(const PredictTake& take, const TrackerTrial& trial,
                            const TrackerEvalOptions& options, TrackerShow* show) {
  TrackerScore score;
  Dancer dancer = dancer_of(take, trial.points, options);
  const bool is_t_pose = trial.start == TrackerStart::kTPose;
  Solved solved = solve_take(dancer, trial, options, {});
  const auto first = static_cast<std::size_t>((is_t_pose ? kSkipped_s : kDanced_s) * options.hz);
  judge_places(dancer.truth, solved, first, score);
  judge_motion(dancer.truth, solved, first, score);
  const auto arm = [](const Skeleton& s) {
    return static_cast<double>(s.offset(Bone::kLeftLowerArm).norm() +
                               s.offset(Bone::kLeftHand).norm());
  };
  score.height_error_m = std::abs(static_cast<double>(standing_height_m(solved.skeleton) -
                                                      standing_height_m(dancer.truth.skeleton)));
  score.arm_error = std::abs(arm(solved.skeleton) / arm(dancer.truth.skeleton) - 1.0);
  std::sort(solved.times_us.begin(), solved.times_us.end());
  score.median_us = percentile(std::span<const double>(solved.times_us), 0.5);
  score.p99_us = percentile(std::span<const double>(solved.times_us), 0.99);
  if (show) *show = {dancer.truth, solved.skeleton, solved.poses};
  Dancer again = dancer_of(take, trial.points, options);
  const LostPoint lost = lost_in_turn(again.truth, trial.points);
  judge_lost(again.truth, solve_take(again, trial, options, lost), lost, score);
  return score;
}

std::vector<TrackerScore> evaluate_trackers(const std::vector<PredictTake>& takes,
                                            const std::vector<TrackerTrial>& trials,
                                            const TrackerEvalOptions& options) {
  std::vector<TrackerScore> each(takes.size() * trials.size());
  in_two_threads(each.size(), [&](std::size_t i) {
    each[i] = judge_trackers(takes[i / trials.size()], trials[i % trials.size()], options);
  });
  std::vector<TrackerScore> out(trials.size());
  for (std::size_t t = 0; t < trials.size(); ++t) {
    TrackerScore& sum = out[t];
    for (std::size_t k = 0; k < takes.size(); ++k) sum.frames += each[k * trials.size() + t].frames;
    for (std::size_t k = 0; k < takes.size(); ++k) {
      const TrackerScore& one = each[k * trials.size() + t];
      const double all = static_cast<double>(sum.frames);
      const double share = static_cast<double>(one.frames) / all;
      for (const auto of :
           {&TrackerScore::joints_m, &TrackerScore::body_m, &TrackerScore::turns_deg,
            &TrackerScore::hips_m, &TrackerScore::proportions_m})
        sum.*of += one.*of / all;
      for (const auto of :
           {&TrackerScore::slide_m_s, &TrackerScore::true_slide_m_s, &TrackerScore::jerk_ratio,
            &TrackerScore::lost_m, &TrackerScore::median_us, &TrackerScore::p99_us,
            &TrackerScore::height_error_m, &TrackerScore::arm_error})
        sum.*of += share * one.*of;
      sum.lost_jump_m = std::max(sum.lost_jump_m, one.lost_jump_m);
    }
  }
  return out;
}

}  // namespace dance
