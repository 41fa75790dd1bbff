#include "research/capture/drawn/drawn_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/pose/interpolate.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/body/guest_look.h"
#include "producers/camera/files/bgr_picture.h"
#include "producers/salsa/salsa_dancer.h"
#include "testing/camera/limb_joints.h"
#include "viewer/gl/offscreen.h"
#include "viewer/gl/picture.h"
#include "viewer/stage/stage_renderer.h"

namespace dance {

using Eigen::Vector3d;

namespace {

constexpr int kWidth_px = 960, kHeight_px = 540;
constexpr double kDrawnHz = 30.0;
constexpr double kFov_deg = 65.0;
constexpr double kPhase_s = 0.011;
constexpr float kTarget_m = 0.95f;

// The dance at any time, its middle above the stage's.
class DrawnDance {
 public:
  static Result<DrawnDance> open(const DrawnWishes& wishes) {
    DrawnDance dance;
    if (wishes.take.empty()) {
      SalsaDancer dancer{SalsaStyle()};
      dance.skeleton_ = dancer.skeleton();
      const auto count = static_cast<std::size_t>((wishes.seconds + 1.0) * dance.hz_);
      dance.poses_.resize(count);
      for (std::size_t i = 0; i < count; ++i)
        dancer.dance_at(Duration::seconds(static_cast<double>(i) / dance.hz_), dance.poses_[i]);
    } else {
      DANCE_TRY(const CodecTake take, load_codec_take(wishes.take, dance.hz_));
      dance.skeleton_ = take.skeleton;
      dance.poses_ = take.poses;
      dance.hz_ = take.hz;
    }
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (const Pose& pose : dance.poses_)
      middle += pose.p_WH_m / static_cast<float>(dance.poses_.size());
    middle.y() = 0.0f;
    for (Pose& pose : dance.poses_) pose.p_WH_m -= middle;
    return dance;
  }
  const Skeleton& skeleton() const { return skeleton_; }
  double length_s() const { return static_cast<double>(poses_.size() - 2) / hz_; }
  Pose at(double t_s) const {
    const double place = std::clamp(t_s, 0.0, length_s()) * hz_;
    const auto before = static_cast<std::size_t>(place);
    return interpolate(poses_[before], poses_[before + 1],
                       static_cast<float>(place - static_cast<double>(before)));
  }

 private:
  Skeleton skeleton_;
  std::vector<Pose> poses_;
  double hz_ = 120.0;
};

// One of the webcams: draws, looks, keeps.
class DrawnCamera {
 public:
  static Result<DrawnCamera> open(const DrawnWishes& wishes, double yaw_rad, double pitch_rad,
                                  const std::string& called) {
    DrawnCamera drawn;
    drawn.camera_.target_W_m = {0.0f, kTarget_m, 0.0f};
    drawn.camera_.yaw_rad = static_cast<float>(yaw_rad);
    drawn.camera_.pitch_rad = static_cast<float>(pitch_rad);
    drawn.camera_.distance_m = static_cast<float>(wishes.distance_m);
    drawn.lens_ = assumed_pinhole(kWidth_px, kHeight_px, kFov_deg);
    drawn.camera_.fov_y_rad =
        static_cast<float>(2.0 * std::atan(0.5 * kHeight_px / drawn.lens_.fy_px));
    EstimatorOptions seeing;
    seeing.model = wishes.model;
    DANCE_TRY(drawn.estimator_, PoseEstimator::open(seeing));
    if (!wishes.folder.empty()) {
      drawn.folder_ = wishes.folder + "/" + called;
      std::error_code error;
      std::filesystem::create_directories(drawn.folder_, error);
      if (error) return fail("'" + drawn.folder_ + "' cannot be made: " + error.message());
    }
    return drawn;
  }
  const Pinhole& lens() const { return lens_; }
  Eigen::Matrix3d R_WC() const {
    // Right, up, backward become right, down, forward.
    Eigen::Matrix3d R = camera_.axes_W().cast<double>();
    R.col(1) = -R.col(1);
    R.col(2) = -R.col(2);
    return R;
  }
  Vector3d p_WC_m() const { return camera_.eye_W_m().cast<double>(); }

  Result<BodyLandmarks> look(StageRenderer& renderer, const SceneState& scene, MonoTime stamp) {
    const std::string file = fmt::format("{}/{:05}.png", folder_, ++pictures_);
    Frame frame;
    frame.capture_time = stamp;
    if (!folder_.empty() && std::filesystem::exists(file)) {
      DANCE_TRY(frame.image, read_bgr_picture(file));
      estimator_->estimate(frame);
      return estimator_->unfiltered();
    }
    if (auto drawn = renderer.draw(scene, camera_, kWidth_px, kHeight_px); !drawn)
      return tl::make_unexpected(drawn.error());
    Picture picture = read_bound_framebuffer(kWidth_px, kHeight_px);
    if (!folder_.empty())
      if (auto written = write_png(file, picture); !written)
        return tl::make_unexpected(written.error());
    cv::cvtColor(cv::Mat(kHeight_px, kWidth_px, CV_8UC3, picture.rgb.data()), frame.image,
                 cv::COLOR_RGB2BGR);
    estimator_->estimate(frame);
    return estimator_->unfiltered();
  }

 private:
  OrbitCamera camera_;
  Pinhole lens_;
  std::unique_ptr<PoseEstimator> estimator_;
  std::string folder_;
  int pictures_ = 0;
};

SceneState scene_of(const DrawnDance& dance, double t_s, const GuestId& guest,
                    const std::shared_ptr<const AvatarModel>& avatar, int camera) {
  SceneState scene;
  scene.stage = camera;
  scene.time = MonoTime() + Duration::seconds(1.0 + t_s);
  SceneGuest dancer;
  dancer.id = guest;
  dancer.avatar = avatar;
  dancer.skeleton = dance.skeleton();
  dancer.pose = dance.at(t_s);
  scene.guests.push_back(dancer);
  return scene;
}

void write_truth(const DrawnDance& dance, double t_s, SceneFrame& frame) {
  BodyFrames frames;
  forward_kinematics(dance.skeleton(), dance.at(t_s), frames);
  frame.truth_W_m.fill(Vector3d::Zero());
  for (const auto& [landmark, bone] : kLimbJoints)
    frame.truth_W_m[index_of(landmark)] = frames.position(bone).cast<double>();
}

}  // namespace

Result<DrawnStage> draw_stage(const DrawnWishes& wishes) {
  const auto guest = GuestId::parse(wishes.guest);
  if (!guest) return fail("--guest '" + wishes.guest + "': " + kGuestIdRule);
  DANCE_TRY(const DrawnDance dance, DrawnDance::open(wishes));
  DANCE_TRY(const auto context, OffscreenContext::create());
  DANCE_TRY(const auto renderer, StageRenderer::create(Quality::kLow));
  const auto avatar = std::make_shared<const AvatarModel>(
      mannequin_model(dance.skeleton(), look_of(*guest), false));
  const double around_rad = wishes.around_deg * std::numbers::pi / 180.0;
  DANCE_TRY(auto first, DrawnCamera::open(wishes, 0.0, 0.07, "first"));
  DANCE_TRY(auto second, DrawnCamera::open(wishes, around_rad, 0.14, "second"));
  DrawnStage drawn;
  SeveralStage& stage = drawn.stage;
  stage.first.name = wishes.take.empty() ? "salsa" : wishes.take;
  stage.first.hz = kDrawnHz;
  stage.first.camera.pinhole = first.lens();
  stage.first.R_WC = first.R_WC();
  stage.first.p_WC_m = first.p_WC_m();
  stage.first.height_m = static_cast<double>(standing_height_m(dance.skeleton()));
  stage.other.eye.camera.pinhole = second.lens();
  stage.other.eye.later_s = 1e-3 * wishes.later_ms;
  stage.other.eye.phase_s = kPhase_s;
  stage.other.R_WC = second.R_WC();
  stage.other.p_WC_m = second.p_WC_m();
  const double length_s = std::min(wishes.seconds, dance.length_s());
  int seen = 0, pictures = 0;
  for (double t_s = 0.0; t_s < length_s; t_s += 1.0 / kDrawnHz) {
    SceneFrame frame;
    const MonoTime now = MonoTime() + Duration::seconds(1.0 + t_s);
    DANCE_TRY(frame.landmarks, first.look(*renderer, scene_of(dance, t_s, *guest, avatar, 0), now));
    write_truth(dance, t_s, frame);
    EyeScene::Moment moment;
    moment.time = now + Duration::seconds(kPhase_s);
    DANCE_TRY(moment.landmarks,
              second.look(*renderer, scene_of(dance, t_s + kPhase_s, *guest, avatar, 1),
                          moment.time + Duration::seconds(stage.other.eye.later_s)));
    pictures += 2;
    seen += (frame.landmarks.found ? 1 : 0) + (moment.landmarks.found ? 1 : 0);
    stage.first.frames.push_back(frame);
    stage.other.moments.push_back(moment);
  }
  drawn.seen_percent = pictures > 0 ? 100.0 * seen / pictures : 0.0;
  return drawn;
}

}  // namespace dance
