// CameraRig: controls the camera: presets, mouse drags, framing of all dancers (or one), and a slow
// turn when idle.
//
// Units/frames: angles in rad, W; drags are shares of the picture's height.
// Ownership:    plain value.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none; a focus on a missing guest frames all.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/base/time.h"
#include "viewer/draw/camera.h"
#include "viewer/draw/scene.h"

namespace dance {

// kAuto looks across the line on which the dancers stand.
enum class CameraPreset { kAuto, kFront, kSide, kTop, kOrbit };

class CameraRig {
 public:
  explicit CameraRig(CameraPreset preset);

  void drag_orbit(float right, float up);
  void drag_pan(float right, float up);
  void zoom(float notches);  // positive comes nearer
  void frame_all();
  void focus(const GuestId& guest);
  void toggle_turning() { is_turning_ = !is_turning_; }
  void set_turning(bool turning) { is_turning_ = turning; }
  bool is_turning() const { return is_turning_; }

  // Moves smoothly by dt towards the target of the scene.
  void update(const SceneState& scene, float aspect, Duration dt);
  // Jumps to the target, for single pictures. Several scenes share one frame.
  void jump(const std::vector<const SceneState*>& scenes, float aspect);

  const OrbitCamera& camera() const { return camera_; }
  // The view chosen for this stage before any user input: it determines the light's direction.
  float stage_yaw_rad() const { return stage_yaw_rad_; }

 private:
  void choose_yaw(const SceneState& scene);
  std::vector<Eigen::Vector3f> points_of(const SceneState& scene) const;

  CameraPreset preset_;
  OrbitCamera camera_;
  std::optional<GuestId> focus_;
  bool is_turning_ = false;
  bool is_free_ = false;        // panned away: no framing until requested
  bool yaw_is_chosen_ = false;  // by hand, by preset, or from the first dancers
  std::size_t yaw_chosen_for_ = 0;
  bool has_framed_ = false;
  float zoom_ = 1.0f;
  float stage_yaw_rad_ = 0.0f;
  float swing_s_ = 0.0f;
};

}  // namespace dance
