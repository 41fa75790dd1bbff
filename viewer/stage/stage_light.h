// The light of one picture: where it comes from, and the map of what it does not reach.
//
// Units/frames: W.
// Ownership:    owns its OpenGL objects.
// Threads:      the one whose context is current.
// Failure:      none.
#pragma once

#include <Eigen/Core>

#include "viewer/gl/gl_objects.h"

namespace dance {

// The colours of the light, linear RGB. The defaults were chosen by eye for the plain stage.
struct StageMood {
  Eigen::Vector3f key{1.50f, 1.34f, 1.12f};
  Eigen::Vector3f sky{0.42f, 0.46f, 0.55f};     // fills from above
  Eigen::Vector3f bounce{0.30f, 0.22f, 0.16f};  // fills from below
  Eigen::Vector3f rim{0.55f, 0.62f, 0.80f};     // at the edge of bodies
};

class StageLight {
 public:
  // The texture unit of the map, for all programs that are lit.
  static constexpr int kUnit = 0;

  explicit StageLight(int map_px);

  // The direction the key light comes from, about the vertical, as the camera's yaw.
  void set_yaw(float yaw_rad);
  void set_mood(const StageMood& mood) { mood_ = mood; }
  // So that the map holds a ball round the guests.
  void shine_on(const Eigen::Vector3f& centre_W_m, float radius_m);
  const Eigen::Matrix4f& light_from_world() const { return light_from_world_; }

  void begin_map() const;  // draw what casts shadows
  void end_map() const;    // then this
  // Makes the program current with what kLight of the shaders wants.
  void use(const GlProgram& program, const Eigen::Vector3f& eye_W_m) const;

 private:
  int map_px_;
  GlTexture map_;
  GlFramebuffer target_;
  StageMood mood_;
  Eigen::Vector3f to_light_W_;
  Eigen::Matrix4f light_from_world_ = Eigen::Matrix4f::Identity();
  float radius_m_ = 1.0f;
};

}  // namespace dance
