#include "viewer/view/follow_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/scene/figure_stature.h"
#include "viewer/view/camera_rig.h"

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kHalfCircle_rad = std::numbers::pi_v<float>;
// Behind the right shoulder: what the dancer sees is in the picture too.
constexpr float kBehind_rad = kHalfCircle_rad - 0.45f;
constexpr float kPitch_rad = 0.16f;
constexpr float kLowestView_rad = -0.05f;
constexpr float kHighestView_rad = 1.5f;
// A dancer with raised arms, and with arms held out to the sides.
constexpr float kTall = 1.42f;
constexpr float kWide = 1.2f;
constexpr float kMiddle = 0.56f;  // of the height
constexpr float kFace = 0.92f;
// The place goes with the dancer soon, up and down hardly, so that steps do not shake the picture;
// the side slowly, so that a spin of less than two seconds is seen and not taken along.
constexpr float kPlace_s = 0.25f;
constexpr float kHeight_s = 1.2f;
constexpr float kFacing_s = 1.1f;
// While the dancer spins, the mean of the facings says little.
constexpr float kSureFacing = 0.35f;

float share_of(float dt_s, float softness_s) { return 1.0f - std::exp(-dt_s / softness_s); }
float yaw_of(const Vector3f& direction) { return std::atan2(direction.x(), direction.z()); }
}  // namespace

FollowCamera::FollowCamera(Keeps keeps)
    : keeps_(keeps), side_rad_(keeps == Keeps::kSideOfDancer ? kBehind_rad : 0.0f) {
  reset();
}

void FollowCamera::reset() {
  has_begun_ = false;
  side_rad_ = keeps_ == Keeps::kSideOfDancer ? kBehind_rad : 0.0f;
  zoom_ = 1.0f;
  camera_.pitch_rad = kPitch_rad;
  camera_.is_mirrored = keeps_ == Keeps::kPlaceInRoom;
}

void FollowCamera::drag_orbit(float right, float up) {
  // What is in the picture goes with the hand, in a mirror too.
  const float turn = (camera_.is_mirrored ? 2.5f : -2.5f) * right;
  side_rad_ += turn;
  camera_.yaw_rad += turn;
  camera_.pitch_rad = std::clamp(camera_.pitch_rad - up * 2.0f, kLowestView_rad, kHighestView_rad);
}

void FollowCamera::zoom(float notches) {
  zoom_ = std::clamp(zoom_ * std::exp(-0.12f * notches), 0.3f, 5.0f);
}

float FollowCamera::wanted_distance_m(const SceneGuest& guest, float aspect) const {
  const float half_m = 0.5f * figure_height_m(guest) * std::max(kTall, kWide / aspect);
  return zoom_ * half_m / std::tan(0.5f * camera_.fov_y_rad);
}

float FollowCamera::middle_m(const SceneGuest& guest) const {
  return (kFace + share_of_frame(zoom_) * (kMiddle - kFace)) * figure_height_m(guest);
}

// The camera goes farther away to make up for the covered part, and keeps the dancer in the middle
// of the rest.
OrbitCamera FollowCamera::camera() const {
  OrbitCamera framed = camera_;
  framed.distance_m /= 1.0f - covered_below_;
  const float height_m = 2.0f * framed.distance_m * std::tan(0.5f * framed.fov_y_rad);
  framed.target_W_m -= 0.5f * covered_below_ * height_m * framed.axes_W().col(1);
  return framed;
}

void FollowCamera::jump(const SceneGuest& guest, float aspect) {
  has_begun_ = true;
  guest_ = guest.id;
  facing_W_ = facing_W(guest);
  camera_.yaw_rad = yaw_of(facing_W_) + side_rad_;
  camera_.target_W_m = Vector3f(guest.pose.p_WH_m.x(), middle_m(guest), guest.pose.p_WH_m.z());
  camera_.distance_m = wanted_distance_m(guest, aspect);
}

void FollowCamera::update(const SceneGuest& guest, float aspect, Duration dt) {
  if (!has_begun_ || guest_ != guest.id) return jump(guest, aspect);
  const auto dt_s = static_cast<float>(std::clamp(dt.as_seconds(), 0.0, 0.25));
  const Vector3f hips = guest.pose.p_WH_m;
  const float share = share_of(dt_s, kPlace_s);
  Vector3f& target = camera_.target_W_m;
  target.x() += share * (hips.x() - target.x());
  target.z() += share * (hips.z() - target.z());
  // A floor above zero, a jump, a sitting dancer.
  const float rise_m = stature_of(guest).legs * (hips.y() - guest.skeleton.hips_height_m());
  const float wanted_m = middle_m(guest) + rise_m;
  target.y() += share_of(dt_s, zoom_ < 1.0f ? kPlace_s : kHeight_s) * (wanted_m - target.y());
  camera_.distance_m += share * (wanted_distance_m(guest, aspect) - camera_.distance_m);
  facing_W_ += share_of(dt_s, kFacing_s) * (facing_W(guest) - facing_W_);
  if (keeps_ != Keeps::kSideOfDancer || facing_W_.norm() < kSureFacing) return;
  const float wanted = yaw_of(facing_W_) + side_rad_;
  const float turn = std::remainder(wanted - camera_.yaw_rad, 2.0f * kHalfCircle_rad);
  camera_.yaw_rad += share_of(dt_s, 0.5f * kFacing_s) * turn;
}

}  // namespace dance
