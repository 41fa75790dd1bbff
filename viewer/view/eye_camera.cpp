#include "viewer/view/eye_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pose/kinematics.h"
#include "viewer/scene/figure_stature.h"

namespace dance {

using Eigen::Vector3f;

namespace {
constexpr float kStraight_rad = std::numbers::pi_v<float>;
constexpr float kFieldOfView_rad = 1.35f;
constexpr float kNarrowest_rad = 0.4f;
constexpr float kWidest_rad = 1.9f;
constexpr float kSteepest_rad = 1.35f;
constexpr float kSoftness_s = 0.06f;
// Heads are carried a little forward; eyes look at the partner all the same.
constexpr float kLooksUp_rad = 0.08f;
}  // namespace

void EyeCamera::drag_orbit(float right, float up) {
  aside_rad_ = std::clamp(aside_rad_ - right * 1.6f, -kStraight_rad, kStraight_rad);
  down_rad_ = std::clamp(down_rad_ - up * 1.6f, -kSteepest_rad, kSteepest_rad);
}

void EyeCamera::zoom(float notches) {
  camera_.fov_y_rad =
      std::clamp(camera_.fov_y_rad * std::exp(-0.08f * notches), kNarrowest_rad, kWidest_rad);
}

void EyeCamera::reset() {
  has_begun_ = false;
  aside_rad_ = down_rad_ = 0.0f;
  camera_.fov_y_rad = kFieldOfView_rad;
  camera_.distance_m = 1.0f;
}

void EyeCamera::update(const SceneGuest& guest, Duration dt) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  const Vector3f forward = frames.R_WB[index_of(Bone::kHead)] * Vector3f::UnitZ();
  // The camera looks against its own backward axis.
  const float level = std::hypot(forward.x(), forward.z());
  const bool is_level = level > 0.2f;  // straight up or down there is no yaw
  const float yaw = is_level ? std::atan2(-forward.x(), -forward.z()) : head_yaw_rad_;
  const float pitch = std::atan2(-forward.y(), level) - kLooksUp_rad;
  if (!has_begun_ || guest_ != guest.id) {
    has_begun_ = true;
    guest_ = guest.id;
    head_yaw_rad_ = yaw;
    head_pitch_rad_ = pitch;
  }
  const auto dt_s = static_cast<float>(std::clamp(dt.as_seconds(), 0.0, 0.25));
  const float share = 1.0f - std::exp(-dt_s / kSoftness_s);
  head_yaw_rad_ += share * std::remainder(yaw - head_yaw_rad_, 2.0f * kStraight_rad);
  head_pitch_rad_ += share * (pitch - head_pitch_rad_);
  camera_.yaw_rad = head_yaw_rad_ + aside_rad_;
  camera_.pitch_rad = std::clamp(head_pitch_rad_ + down_rad_, -kSteepest_rad, kSteepest_rad);
  camera_.target_W_m = figure_eyes_W_m(guest) - camera_.distance_m * camera_.axes_W().col(2);
}

}  // namespace dance
