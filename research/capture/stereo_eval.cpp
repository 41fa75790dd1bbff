#include "research/capture/stereo_eval.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/core/mat.hpp>

#include "core/base/assert.h"
#include "core/base/median.h"
#include "producers/salsa/salsa_dancer.h"
#include "research/capture/thread_time.h"
#include "testing/camera/limb_joints.h"

namespace dance {
namespace {

struct OneError {
  double depth_m;
  double scale;
};

ErrorSummary summary_of(const std::vector<OneError>& errors) {
  ErrorSummary out;
  if (errors.empty()) return out;
  std::vector<double> absolute;
  for (const OneError& e : errors) {
    absolute.push_back(1e3 * std::abs(e.depth_m));
    out.mean_mm += absolute.back();
    out.bias_mm += 1e3 * e.depth_m;
    out.scale_mean_percent += 100.0 * std::abs(e.scale);
  }
  const auto count = static_cast<double>(errors.size());
  out.mean_mm /= count;
  out.bias_mm /= count;
  out.scale_mean_percent /= count;
  std::sort(absolute.begin(), absolute.end());
  out.p95_mm = absolute[std::min(absolute.size() - 1, static_cast<std::size_t>(0.95 * count))];
  return out;
}

// The distance that two independent runs of the network give: each joint's disparity, less the
// network's own relative depth, their median.
double triangulated_m(const RectifiedPair& pair, const BodyLandmarks& left,
                      const BodyLandmarks& right, double scale) {
  std::vector<double> all;
  for (const auto& [l, bone] : kLimbJoints) {
    const Eigen::Vector2d a = pair.rectified(Side::kLeft, left.image(l).head<2>().cast<double>());
    const Eigen::Vector2d b = pair.rectified(Side::kRight, right.image(l).head<2>().cast<double>());
    if (a.x() - b.x() > 1.0)
      all.push_back(pair.p_L_m(a, a.x() - b.x()).z() - scale * left.world(l).z());
  }
  return median_of<double>(all);
}

struct Tally {
  std::array<std::vector<OneError>, kDepthWayCount> errors;
  double joints = 0.0;
  int within = 0;
  double us = 0.0;
  std::vector<double> rows_px;
};

// The salsa dancer or a take, moment by moment.
class Motion {
 public:
  Motion(std::uint64_t seed, const std::vector<CodecTake>& takes)
      : take_(takes.empty() ? nullptr : &takes[seed % takes.size()]), dancer_(style_of(seed)) {}

  const Skeleton& skeleton() const { return take_ ? take_->skeleton : dancer_.skeleton(); }
  Pose at(Duration t) {
    Pose pose;
    if (!take_) {
      dancer_.dance_at(t, pose);
      return pose;
    }
    const double place = t.as_seconds() * take_->hz;
    return take_->poses[static_cast<std::size_t>(place) % take_->poses.size()];
  }

 private:
  static SalsaStyle style_of(std::uint64_t seed) {
    SalsaStyle style;
    style.role = seed % 2 ? SalsaRole::kLead : SalsaRole::kFollow;
    style.seed = seed;
    style.heading_deg = Random(seed + 5).uniform(-180.0, 180.0);
    return style;
  }
  const CodecTake* take_;
  SalsaDancer dancer_;
};

void evaluate_dancer(const StereoEvalCase& what, std::uint64_t seed, int frames, bool is_exact,
                     const std::vector<CodecTake>& takes, StereoEval& out, Tally& tally) {
  Random random(seed);
  const StereoRig truth = drawn_rig();
  const StereoRig known = is_exact ? truth : calibrated_rig(truth, seed);
  SceneEyes eyes;
  eyes.wall_m = what.distance_m + 2.0;
  eyes.right_gain = random.uniform(0.85, 1.18);
  StereoScene scene(truth, eyes, seed);
  StereoDepth depth(known);
  const RectifiedPair pair(known);
  Motion motion(seed, takes);
  NetworkErrors errors;
  errors.image_px = what.image_px;
  errors.scale = random.uniform(0.92, 1.08);
  const DancerLook look{random.uniform(0.88, 1.15), what.contrast};
  StageCamera camera;
  camera.distance_m = what.distance_m;
  cv::Mat left;
  cv::Mat right;
  const Duration later = Duration::seconds(1e-3 * what.right_later_ms);
  for (int frame = 0; frame < frames; ++frame) {
    const Duration t = Duration::ms(500) + Duration::ms(370) * frame;
    Pose pose = motion.at(t);
    Pose pose_later = motion.at(t + later);
    // Couples walk about; the camera is to see the dancer at the distance that is asked about.
    const Eigen::Vector3f start = pose.p_WH_m;
    camera.aside_m = random.uniform(-0.5, 0.5);
    for (Pose* p : {&pose, &pose_later}) {
      p->p_WH_m.x() -= start.x();
      p->p_WH_m.z() -= 0.7f * start.z();
    }
    BodyFrames body;
    BodyFrames body_later;
    forward_kinematics(motion.skeleton(), pose, body);
    forward_kinematics(motion.skeleton(), pose_later, body_later);
    scene.draw(body_of(body, camera, look), body_of(body_later, camera, look), left, right);
    const auto joints = joints_of(body, camera);
    const double true_m =
        0.5 * (joints[index_of(Landmark::kLeftHip)] + joints[index_of(Landmark::kRightHip)]).z();
    BodyLandmarks seen = landmarks_of(joints, truth, Side::kLeft, errors, random);
    const BodyLandmarks other =
        landmarks_of(joints_of(body_later, camera), truth, Side::kRight, errors, random);
    seen.is_new = frame == 0;
    seen.capture_time = MonoTime() + t;
    const double start_us = 1e-3 * static_cast<double>(thread_time_ns());
    const DepthHint hint = depth.hint(left, right, seen);
    tally.us += 1e-3 * static_cast<double>(thread_time_ns()) - start_us;
    ++out.frames;
    const auto one_eye = fit_monocular(depth.samples());
    if (hint.joints == 0 || !one_eye) continue;
    ++out.hinted;
    tally.joints += hint.joints;
    tally.within += std::abs(hint.hips_depth_m - true_m) < 2.0 * hint.spread_m ? 1 : 0;
    const double one_m = one_eye->p_CH_m.z();
    const double two_m = triangulated_m(pair, seen, other, 1.0);
    const auto add = [&](DepthWay way, double got_m, double scale) {
      tally.errors[static_cast<std::size_t>(way)].push_back(
          {got_m - true_m, scale / errors.scale - 1.0});
    };
    add(DepthWay::kStereo, hint.hips_depth_m, hint.scale);
    add(DepthWay::kOneEye, one_m, 1.0);
    add(DepthWay::kOneEyeKnownSize, one_m * errors.scale, errors.scale);
    add(DepthWay::kTwoNetworks, two_m, two_m / one_m);
  }
  tally.rows_px.push_back(depth.row_offset_px());
}

}  // namespace

StereoEval evaluate_stereo(const StereoEvalCase& what, const StereoEvalOptions& options,
                           const std::vector<CodecTake>& takes) {
  StereoEval out;
  out.what = what;
  Tally tally;
  const int dancers = std::max(1, std::min(options.dancers, options.frames));
  for (int i = 0; i < dancers; ++i)
    evaluate_dancer(what, options.seed + static_cast<std::uint64_t>(i),
                    (options.frames + dancers - 1 - i) / dancers, options.is_calibration_exact,
                    takes, out, tally);
  for (std::size_t way = 0; way < kDepthWayCount; ++way)
    out.errors[way] = summary_of(tally.errors[way]);
  if (out.hinted > 0) {
    out.joints_mean = tally.joints / out.hinted;
    out.within_two_spreads = static_cast<double>(tally.within) / out.hinted;
  }
  out.us_per_frame = tally.us / std::max(1, out.frames);
  for (const double px : tally.rows_px)
    out.row_offset_px += std::abs(px) / static_cast<double>(tally.rows_px.size());
  return out;
}

std::vector<StereoEvalCase> stereo_eval_cases() {
  return {{"near", 2.2, 25.0, 1.75},          {"usual", 3.0, 25.0, 1.75},
          {"far", 4.5, 25.0, 1.75},           {"plain clothes", 3.0, 7.0, 1.75},
          {"poor landmarks", 3.0, 25.0, 4.0}, {"eyes 10 ms apart", 3.0, 25.0, 1.75, 10.0}};
}

}  // namespace dance
