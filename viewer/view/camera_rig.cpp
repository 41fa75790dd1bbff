#include "viewer/view/camera_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFill = 0.86f;
constexpr float kUsualPitch_rad = 0.13f;
constexpr float kPitchPerGuest_rad = 0.018f;
constexpr float kHighestPitch_rad = 1.54f;
constexpr float kLowestPitch_rad = -0.05f;  // never from under the floor
constexpr float kClosest_m = 0.6f;
constexpr float kFurthest_m = 120.0f;
// Softness of framing: backing off is quick, so that nobody leaves the picture; coming near is
// slow.
constexpr float kBackOff_s = 0.35f;
constexpr float kComeNear_s = 1.6f;
constexpr float kFollow_s = 0.6f;
constexpr float kTurn_rad_per_s = 0.12f;
// With the automatic camera the turn is a swing to both sides of the best view.
constexpr float kSwing_rad = 0.45f;
constexpr float kSwingPeriod_s = 26.0f;

float share_after(float dt_s, float softness_s) { return 1.0f - std::exp(-dt_s / softness_s); }
}  // namespace

float share_of_frame(float zoom) { return std::pow(std::min(zoom, 1.0f), 1.4f); }

CameraRig::CameraRig(CameraPreset preset) : preset_(preset) {
  camera_.pitch_rad = kUsualPitch_rad;
  yaw_is_chosen_ = preset != CameraPreset::kAuto;
  if (preset == CameraPreset::kFront) camera_.yaw_rad = 0.0f;
  if (preset == CameraPreset::kSide) camera_.yaw_rad = 0.5f * kPi;
  if (preset == CameraPreset::kTop) {
    camera_.yaw_rad = 0.0f;
    camera_.pitch_rad = kHighestPitch_rad;
  }
  if (preset == CameraPreset::kOrbit) {
    camera_.yaw_rad = 0.6f;
    camera_.pitch_rad = 0.28f;
  }
  stage_yaw_rad_ = camera_.yaw_rad;
}

void CameraRig::drag_orbit(float right, float up) {
  camera_.yaw_rad -= right * 2.5f;
  camera_.pitch_rad =
      std::clamp(camera_.pitch_rad - up * 2.0f, kLowestPitch_rad, kHighestPitch_rad);
  yaw_is_chosen_ = true;
  is_turning_ = false;
}

void CameraRig::drag_pan(float right, float up) {
  const float height_m = 2.0f * camera_.distance_m * std::tan(0.5f * camera_.fov_y_rad);
  const Eigen::Matrix3f axes = camera_.axes_W();
  camera_.target_W_m -= height_m * (right * axes.col(0) + up * axes.col(1));
  is_free_ = true;
}

void CameraRig::zoom(float notches) {
  const float factor = std::exp(-0.12f * notches);
  zoom_ = std::clamp(zoom_ * factor, 0.15f, 6.0f);
  camera_.distance_m = std::clamp(camera_.distance_m * factor, kClosest_m, kFurthest_m);
}

void CameraRig::frame_all() {
  focus_.reset();
  is_free_ = false;
  zoom_ = 1.0f;
}

void CameraRig::focus(const GuestId& guest) {
  focus_ = guest;
  is_free_ = false;
  zoom_ = 1.0f;
}

bool CameraRig::has_focus(const SceneState& scene) const {
  return focus_ && std::any_of(scene.guests.begin(), scene.guests.end(),
                               [this](const SceneGuest& it) { return it.id == *focus_; });
}

std::vector<Vector3f> CameraRig::points_of(const SceneState& scene) const {
  std::vector<Vector3f> points;
  const bool is_of_one = has_focus(scene);
  for (const SceneGuest& guest : scene.guests)
    if (!is_of_one || guest.id == *focus_) append_outline(guest, points);
  return points;
}

// The nearer the camera, the closer the picture's middle is to the middle of the faces.
Vector3f CameraRig::towards_faces(const std::vector<const SceneState*>& scenes,
                                  const Vector3f& target_W_m) const {
  if (zoom_ >= 1.0f) return target_W_m;
  Vector3f faces_W_m = Vector3f::Zero();
  float count = 0.0f;
  for (const SceneState* scene : scenes) {
    const bool is_of_one = has_focus(*scene);
    for (const SceneGuest& guest : scene->guests) {
      if (is_of_one && guest.id != *focus_) continue;
      faces_W_m += face_W_m(guest);
      count += 1.0f;
    }
  }
  if (count == 0.0f) return target_W_m;
  return faces_W_m / count + share_of_frame(zoom_) * (target_W_m - faces_W_m / count);
}

void CameraRig::choose_yaw(const SceneState& scene) {
  if (yaw_is_chosen_ || scene.guests.size() <= yaw_chosen_for_) return;
  std::vector<Vector3f> hips;
  std::vector<Vector3f> facings;
  for (const SceneGuest& guest : scene.guests) {
    hips.push_back(guest.pose.p_WH_m);
    facings.push_back(facing_W(guest));
  }
  camera_.yaw_rad = stage_yaw_rad_ = best_yaw_rad(hips, facings);
  // The more people, the further from above, so that those in front hide fewer of those behind.
  const auto more = static_cast<float>(std::min<std::size_t>(scene.guests.size() - 1, 16));
  camera_.pitch_rad = kUsualPitch_rad + kPitchPerGuest_rad * std::max(0.0f, more - 1.0f);
  // Chosen anew only when more guests come, not at every step they take.
  yaw_chosen_for_ = scene.guests.size();
}

void CameraRig::update(const SceneState& scene, float aspect, Duration dt) {
  const auto dt_s = static_cast<float>(std::clamp(dt.as_seconds(), 0.0, 0.25));
  choose_yaw(scene);
  if (is_turning_) {
    const bool swings = preset_ == CameraPreset::kAuto;
    const float before = std::sin(2.0f * kPi * swing_s_ / kSwingPeriod_s);
    swing_s_ += dt_s;
    const float after = std::sin(2.0f * kPi * swing_s_ / kSwingPeriod_s);
    camera_.yaw_rad += swings ? kSwing_rad * (after - before) : kTurn_rad_per_s * dt_s;
  }
  const std::vector<Vector3f> points = points_of(scene);
  if (is_free_ || points.empty()) return;
  const OrbitCamera framed = frame_points(camera_, points, aspect, kFill, covered_below_);
  const float distance_m = std::clamp(framed.distance_m * zoom_, kClosest_m, kFurthest_m);
  const Vector3f target_W_m = towards_faces({&scene}, framed.target_W_m);
  if (!has_framed_) {
    has_framed_ = true;
    camera_.target_W_m = target_W_m;
    camera_.distance_m = distance_m;
    return;
  }
  const float softness = distance_m > camera_.distance_m ? kBackOff_s : kComeNear_s;
  camera_.distance_m += share_after(dt_s, softness) * (distance_m - camera_.distance_m);
  camera_.target_W_m += share_after(dt_s, kFollow_s) * (target_W_m - camera_.target_W_m);
}

void CameraRig::jump(const std::vector<const SceneState*>& scenes, float aspect) {
  std::vector<Vector3f> points;
  yaw_chosen_for_ = 0;  // single pictures have no view to keep
  for (const SceneState* scene : scenes) {
    choose_yaw(*scene);
    const std::vector<Vector3f> more = points_of(*scene);
    points.insert(points.end(), more.begin(), more.end());
  }
  camera_ = frame_points(camera_, points, aspect, kFill, covered_below_);
  camera_.distance_m *= zoom_;
  camera_.target_W_m = towards_faces(scenes, camera_.target_W_m);
  has_framed_ = !points.empty();
}

}  // namespace dance
