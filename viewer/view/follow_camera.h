// FollowCamera: stays with one dancer. Following, it goes along behind a shoulder and keeps its
// side when the dancer turns; quick turns (a spin) are let go by. As a mirror it keeps its place in
// the room, in front of where the dancer faced at first, and shows left on the left.
//
// Units/frames: rad and metres in W; drags are shares of the picture's height.
// Ownership:    plain value.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include <algorithm>

#include "core/base/time.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

class FollowCamera {
 public:
  enum class Keeps { kSideOfDancer, kPlaceInRoom };
  explicit FollowCamera(Keeps keeps);

  void drag_orbit(float right, float up);
  void zoom(float notches);  // positive comes nearer, to the face
  // Back to the side it begins with; the next update() jumps.
  void reset();

  void update(const SceneGuest& guest, float aspect, Duration dt);
  // The share of the picture's height that a panel covers at its bottom.
  void set_covered_below(float share) { covered_below_ = std::clamp(share, 0.0f, 0.4f); }
  OrbitCamera camera() const;

 private:
  void jump(const SceneGuest& guest, float aspect);
  float middle_m(const SceneGuest& guest) const;
  float wanted_distance_m(const SceneGuest& guest, float aspect) const;

  Keeps keeps_;
  OrbitCamera camera_;
  bool has_begun_ = false;
  GuestId guest_;
  Eigen::Vector3f facing_W_ = Eigen::Vector3f::UnitZ();  // smoothed; not of unit length
  float side_rad_;                                       // from the dancer's front to the camera
  float zoom_ = 1.0f;
  float covered_below_ = 0.0f;
};

}  // namespace dance
