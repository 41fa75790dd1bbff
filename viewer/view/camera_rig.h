// CameraRig: moves the camera: presets, mouse drags, a frame that keeps everybody (or one guest) in
// the picture, and a slow turn while the mouse is not used.
//
// Units/frames: angles in rad, W; drags are shares of the picture's height.
// Ownership:    plain value.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none; a focus on a guest who is not there frames everybody.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/time.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

// kAuto looks across the line on which the dancers stand.
enum class CameraPreset { kAuto, kFront, kSide, kTop, kOrbit };

// How far the picture's middle lies from the faces (0) to the middle of the frame (1) at this zoom.
// Zooms below 1 are nearer; from 1 on the picture's middle is the middle of the frame.
float share_of_frame(float zoom);

class CameraRig {
 public:
  explicit CameraRig(CameraPreset preset);

  void drag_orbit(float right, float up);
  void drag_pan(float right, float up);
  void zoom(float notches);  // positive comes nearer, to the faces
  void frame_all();
  void focus(const GuestId& guest);
  void toggle_turning() { is_turning_ = !is_turning_; }
  void set_turning(bool turning) { is_turning_ = turning; }
  // The share of the picture's height that a panel covers at its bottom: nobody's feet are there.
  void set_covered_below(float share) { covered_below_ = std::clamp(share, 0.0f, 0.4f); }

  // Moves on by dt towards the frame of the scene, smoothly.
  void update(const SceneState& scene, float aspect, Duration dt);
  // Without a transition, for single pictures. Several scenes share one frame.
  void jump(const std::vector<const SceneState*>& scenes, float aspect);

  const OrbitCamera& camera() const { return camera_; }
  // The view that was chosen for this stage, before any drag or turn: the light is placed
  // by it.
  float stage_yaw_rad() const { return stage_yaw_rad_; }

 private:
  void choose_yaw(const SceneState& scene);
  std::vector<Eigen::Vector3f> points_of(const SceneState& scene) const;
  bool has_focus(const SceneState& scene) const;
  Eigen::Vector3f towards_faces(const std::vector<const SceneState*>& scenes,
                                const Eigen::Vector3f& target_W_m) const;

  CameraPreset preset_;
  OrbitCamera camera_;
  std::optional<GuestId> focus_;
  bool is_turning_ = false;
  bool is_free_ = false;        // panned away: frames nothing until frame_all() or focus()
  bool yaw_is_chosen_ = false;  // by hand, by preset, or from the first guests
  std::size_t yaw_chosen_for_ = 0;
  bool has_framed_ = false;
  float zoom_ = 1.0f;
  float covered_below_ = 0.0f;
  float stage_yaw_rad_ = 0.0f;
  float swing_s_ = 0.0f;
};

}  // namespace dance
