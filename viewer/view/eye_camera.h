// EyeCamera: the picture from a dancer's own eyes. It turns with the head but does not tilt with
// it, and shaking is taken out: a picture that rolls makes people ill.
//
// Units/frames: rad and metres in W; drags are shares of the picture's height.
// Ownership:    plain value.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none.
#pragma once

#include "core/base/time.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"

namespace dance {

class EyeCamera {
 public:
  EyeCamera() { reset(); }

  void drag_orbit(float right, float up);  // looks around
  void zoom(float notches);                // positive narrows the field of view
  void reset();                            // straight ahead; the next update() jumps

  void update(const SceneGuest& guest, Duration dt);
  const OrbitCamera& camera() const { return camera_; }

 private:
  OrbitCamera camera_;
  bool has_begun_ = false;
  GuestId guest_;
  float head_yaw_rad_ = 0.0f;
  float head_pitch_rad_ = 0.0f;
  float aside_rad_ = 0.0f;
  float down_rad_ = 0.0f;
};

}  // namespace dance
