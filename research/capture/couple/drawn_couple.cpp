#include "research/capture/couple/drawn_couple.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "core/program/whole_file.h"
#include "formats/avatar/avatar_reader.h"
#include "producers/camera/files/bgr_picture.h"
#include "testing/camera/sight_line.h"
#include "viewer/gl/offscreen.h"
#include "viewer/scene/camera.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

using Eigen::Vector3d;

constexpr double kHold_m = 0.25;
constexpr int kJpegQuality = 92;

struct Capsule {
  Vector3d a, b;
  double radius_m;
};

// The body of a dancer as it hides what is behind.
std::vector<Capsule> capsules_of(const BodyFrames& frames) {
  const auto at = [&](Bone bone) { return Vector3d(frames.position(bone).cast<double>()); };
  std::vector<Capsule> capsules{{at(Bone::kHips), at(Bone::kNeck), 0.14},
                                {at(Bone::kHead), at(Bone::kHead) + Vector3d(0.0, 0.1, 0.0), 0.1}};
  for (const auto& [from, to, radius] :
       {std::tuple{Bone::kLeftUpperArm, Bone::kLeftLowerArm, 0.045},
        std::tuple{Bone::kLeftLowerArm, Bone::kLeftHand, 0.04},
        std::tuple{Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, 0.08},
        std::tuple{Bone::kLeftLowerLeg, Bone::kLeftFoot, 0.05},
        std::tuple{Bone::kRightUpperArm, Bone::kRightLowerArm, 0.045},
        std::tuple{Bone::kRightLowerArm, Bone::kRightHand, 0.04},
        std::tuple{Bone::kRightUpperLeg, Bone::kRightLowerLeg, 0.08},
        std::tuple{Bone::kRightLowerLeg, Bone::kRightFoot, 0.05}})
    capsules.push_back({at(from), at(to), radius});
  return capsules;
}

}  // namespace

class DrawnCouple::Inside {
 public:
  Inside(const CodecTake& lead, const CodecTake& follow, const CoupleView& view)
      : takes_{&lead, &follow}, view_(view) {
    pinhole_ = assumed_pinhole(view.width_px, view.height_px, view.fov_deg);
    frames_ = std::min(lead.poses.size(), follow.poses.size());
    Vector3d middle = Vector3d::Zero();
    for (const CodecTake* take : takes_)
      for (std::size_t f = 0; f < frames_; ++f)
        middle += take->poses[f].p_WH_m.cast<double>() / static_cast<double>(2 * frames_);
    const double yaw = view.yaw_deg * std::numbers::pi / 180.0;
    camera_.yaw_rad = static_cast<float>(yaw);
    camera_.pitch_rad = static_cast<float>(view.pitch_rad);
    camera_.distance_m = static_cast<float>(view.distance_m);
    camera_.fov_y_rad =
        static_cast<float>(2.0 * std::atan(std::tan(view.fov_deg * std::numbers::pi / 360.0) *
                                           view.height_px / view.width_px));
    camera_.target_W_m = {
        static_cast<float>(middle.x()),
        static_cast<float>(view.height_m - view.distance_m * std::sin(view.pitch_rad)),
        static_cast<float>(middle.z())};
    name_ = fmt::format("{}+{} {:.0f}deg", lead.name, follow.name, view.yaw_deg);
    for (std::size_t f = 0; f < frames_; ++f) truths_.push_back(truth_of(f, yaw));
  }

  Result<void> begin_drawing() {
    DANCE_TRY(context_, OffscreenContext::create());
    DANCE_TRY(painter_, StagePainter::create(Quality::kLow, 1.0f));
    for (std::size_t i = 0; i < 2; ++i) {
      if (view_.avatar[i].empty()) continue;
      DANCE_TRY(const auto bytes, read_whole_file(view_.avatar[i], std::size_t{1} << 27));
      auto avatar =
          read_avatar({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
      if (!avatar) return fail(view_.avatar[i] + ": " + avatar.error().what);
      avatars_[i] = std::make_shared<const AvatarModel>(std::move(avatar->model));
    }
    return {};
  }

  Result<cv::Mat> picture(std::size_t frame, Who who) {
    const std::string file = file_of(frame, who);
    if (!file.empty() && std::filesystem::exists(file)) return read_bgr_picture(file);
    if (!painter_)
      if (auto begun = begin_drawing(); !begun) return tl::make_unexpected(begun.error());
    SceneState scene;
    scene.time = MonoTime() + Duration::seconds(1.0 + static_cast<double>(frame) / hz());
    scene.stage = static_cast<int>(who);
    for (std::size_t i = 0; i < 2; ++i) {
      if (who == (i == 0 ? Who::kFollow : Who::kLead)) continue;
      SceneGuest guest;
      guest.id = *GuestId::parse(i == 0 ? "lead" : "follow");
      guest.skeleton = takes_[i]->skeleton;
      guest.pose = takes_[i]->poses[frame];
      guest.pose.capture_time = scene.time;
      guest.avatar = avatars_[i];
      scene.guests.push_back(guest);
    }
    OverlayChoice no_words;
    no_words.tags = no_words.hud = false;
    if (auto drawn = painter_->draw(scene, camera_, view_.width_px, view_.height_px, no_words);
        !drawn)
      return tl::make_unexpected(drawn.error());
    Picture picture = painter_->read();
    cv::Mat bgr;
    cv::cvtColor(cv::Mat(picture.height_px, picture.width_px, CV_8UC3, picture.rgb.data()), bgr,
                 cv::COLOR_RGB2BGR);
    if (file.empty()) return bgr;
    DANCE_TRY(const auto bytes, jpeg_of_bgr(bgr, kJpegQuality));
    std::filesystem::create_directories(std::filesystem::path(file).parent_path());
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return read_bgr_picture(file);
  }

  std::size_t frames_ = 0;
  std::string name_;
  Pinhole pinhole_;
  std::vector<CoupleTruth> truths_;
  double hz() const { return takes_[0]->hz; }

 private:
  std::string file_of(std::size_t frame, Who who) const {
    if (view_.pictures.empty()) return "";
    const char* word = who == Who::kBoth ? "both" : who == Who::kLead ? "lead" : "follow";
    return fmt::format("{}/{} {}/{:06}.jpg", view_.pictures, name_, word, frame);
  }

  CoupleTruth truth_of(std::size_t frame, double yaw_rad) const {
    CoupleTruth truth;
    std::array<BodyFrames, 2> bodies;
    const Vector3d eye = camera_.eye_W_m().cast<double>();
    for (std::size_t i = 0; i < 2; ++i)
      forward_kinematics(takes_[i]->skeleton, takes_[i]->poses[frame], bodies[i]);
    // The camera's eye lies at `yaw` about the vertical; so turned, it is at +z.
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(-yaw_rad, Vector3d::UnitY()).toRotationMatrix();
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<Capsule> partner = capsules_of(bodies[1 - i]);
      int hidden = 0;
      for (std::size_t j = 0; j < kJudgedCount; ++j) {
        const Eigen::Vector3f p = bodies[i].position(kLimbJoints[j].bone);
        truth.joint_W_m[i][j] = turn * p.cast<double>();
        const auto screen = project(camera_, p, static_cast<float>(view_.width_px),
                                    static_cast<float>(view_.height_px));
        truth.joint_px[i][j] =
            screen ? Eigen::Vector2d(screen->x_px, screen->y_px) : Eigen::Vector2d(-1e4, -1e4);
        hidden += std::any_of(partner.begin(), partner.end(), [&](const Capsule& capsule) {
          return nearest_pass(p.cast<double>() - eye, capsule.a - eye, capsule.b - eye).distance_m <
                 capsule.radius_m;
        });
      }
      truth.hidden[i] = static_cast<double>(hidden) / static_cast<double>(kJudgedCount);
    }
    for (std::size_t a = kWristsAt; a < kHipsAt; ++a)
      for (std::size_t b = kWristsAt; b < kHipsAt; ++b)
        if ((truth.joint_W_m[0][a] - truth.joint_W_m[1][b]).norm() < kHold_m)
          truth.is_in_hold = true;
    return truth;
  }

  std::array<const CodecTake*, 2> takes_;
  CoupleView view_;
  OrbitCamera camera_;
  std::array<std::shared_ptr<const AvatarModel>, 2> avatars_;
  std::unique_ptr<OffscreenContext> context_;
  std::unique_ptr<StagePainter> painter_;
};

DrawnCouple::DrawnCouple(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}
DrawnCouple::~DrawnCouple() = default;

Result<std::unique_ptr<DrawnCouple>> DrawnCouple::open(const CodecTake& lead,
                                                       const CodecTake& follow,
                                                       const CoupleView& view) {
  if (lead.poses.empty() || follow.poses.empty() || lead.hz != follow.hz)
    return fail(lead.name + " and " + follow.name + ": not two takes of one rate");
  return std::unique_ptr<DrawnCouple>(
      new DrawnCouple(std::make_unique<Inside>(lead, follow, view)));
}

std::size_t DrawnCouple::frames() const { return inside_->frames_; }
double DrawnCouple::hz() const { return inside_->hz(); }
const Pinhole& DrawnCouple::pinhole() const { return inside_->pinhole_; }
const std::string& DrawnCouple::name() const { return inside_->name_; }
const CoupleTruth& DrawnCouple::truth(std::size_t frame) const { return inside_->truths_[frame]; }
Result<cv::Mat> DrawnCouple::picture(std::size_t frame, Who who) {
  return inside_->picture(frame, who);
}

}  // namespace dance
