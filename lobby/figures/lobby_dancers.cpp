#include "lobby/figures/lobby_dancers.h"

#include <algorithm>
#include <cmath>

#include "viewer/scene/figure_stature.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::uint64_t kSeed = 5;
constexpr double kTempo_bpm = 168.0;

SalsaStyle style_of(SalsaRole role) {
  SalsaStyle style;
  style.role = role;
  style.tempo_bpm = kTempo_bpm;
  style.seed = kSeed;
  return style;
}

// The distance at which a person of that height fills the picture's height, except the margins.
float distance_to_see(float height_m, const OrbitCamera& camera) {
  constexpr float kMargins = 1.18f;
  return 0.5f * kMargins * height_m / std::tan(0.5f * camera.fov_y_rad);
}

float yaw_of(const Vector3f& facing_W) { return std::atan2(facing_W.x(), facing_W.z()); }

}  // namespace

LobbyDancers::LobbyDancers()
    : lead_(style_of(SalsaRole::kLead)), follow_(style_of(SalsaRole::kFollow)) {}

void LobbyDancers::dance_at(SalsaRole role, Duration since, SceneGuest& out) {
  SalsaDancer& dancer = dancer_of(role);
  out.skeleton = dancer.skeleton();
  dancer.dance_at(since, out.pose);
  Hands hands;
  if (dancer.hands_at(since, hands))
    out.hands = hands;
  else
    out.hands.reset();
}

OrbitCamera couple_camera(const SceneState& scene, Duration since) {
  OrbitCamera camera;
  Vector3f middle = Vector3f::Zero();
  float tallest_m = 1.0f;
  for (const SceneGuest& guest : scene.guests) {
    middle += guest.pose.p_WH_m / static_cast<float>(scene.guests.size());
    tallest_m = std::max(tallest_m, figure_height_m(guest));
  }
  camera.target_W_m = {middle.x(), 0.5f * tallest_m, middle.z()};
  camera.distance_m = distance_to_see(tallest_m + 0.15f, camera);
  camera.pitch_rad = 0.10f;
  camera.yaw_rad = 0.7f + 0.45f * static_cast<float>(std::sin(0.12 * since.as_seconds()));
  return camera;
}

OrbitCamera figure_camera(const SceneGuest& guest, float turn_rad) {
  OrbitCamera camera;
  const float height_m = figure_height_m(guest);
  camera.target_W_m = {guest.pose.p_WH_m.x(), 0.5f * height_m, guest.pose.p_WH_m.z()};
  camera.distance_m = distance_to_see(height_m, camera);
  camera.pitch_rad = 0.06f;
  camera.yaw_rad = yaw_of(facing_W(guest)) + turn_rad;
  return camera;
}

}  // namespace dance
