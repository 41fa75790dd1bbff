// StageRenderer: draws the stage — backdrop, floor, bodies, their shadows and mirror images — from
// a SceneState and a camera. Each kind of part is one instanced draw call for all guests together.
//
// Units/frames: metres in W; the finished picture is 8-bit sRGB.
// Ownership:    owns its OpenGL objects; the context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() and draw() tell what the driver refuses; OpenGL errors are our bugs
//               (check_gl()).
#pragma once

#include <memory>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/picture_target.h"
#include "viewer/scene/camera.h"
#include "viewer/scene/scene.h"
#include "viewer/stage/body_part.h"
#include "viewer/stage/capsule_mesh.h"

namespace dance {

// kLow leaves out antialiasing, mirror images and fingers, for graphics without a card.
enum class Quality { kLow, kHigh };

class StageRenderer {
 public:
  static Result<std::unique_ptr<StageRenderer>> create(Quality quality);

  // The direction the key light comes from, about the vertical, as the camera's yaw.
  void set_light_yaw(float yaw_rad);
  // Leaves the finished picture in target().finished(), bound.
  Result<void> draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                    int height_px);
  const PictureTarget& target() const { return target_; }
  Quality quality() const { return quality_; }

 private:
  struct Stage {  // where the guests are
    Eigen::Vector3f centre_W_m;
    float radius_m;
  };

  explicit StageRenderer(Quality quality);
  Result<void> link_programs();
  void make_shadow_map();
  void make_spots();
  CapsuleMesh& bodies() { return is_crowded_ ? large_for_many_ : large_; }
  Stage gather(const SceneState& scene);
  void draw_shadow_map();
  void draw_backdrop(const Eigen::Matrix4f& clip_from_world);
  void draw_bodies(const Eigen::Matrix4f& clip_from_world, float mirror);
  void draw_floor(const Eigen::Matrix4f& clip_from_world, const Stage& stage);
  void draw_spots(const Eigen::Matrix4f& clip_from_world);
  void finish_picture();
  void use_lit(const GlProgram& program, const Eigen::Vector3f& eye_W_m);

  Quality quality_;
  bool is_crowded_ = false;
  BodyParts parts_;
  CapsuleMesh large_;
  CapsuleMesh large_for_many_;
  CapsuleMesh small_;
  PictureTarget target_;
  GlProgram body_;
  GlProgram shadow_;
  GlProgram floor_;
  GlProgram spot_;
  GlProgram backdrop_;
  GlProgram finish_;
  GlVertexArray no_vertices_;
  GlVertexArray spot_array_;
  GlBuffer spot_buffer_;
  GlTexture shadow_map_;
  GlFramebuffer shadow_target_;
  Eigen::Vector3f to_light_W_;
  Eigen::Vector3f eye_W_m_ = Eigen::Vector3f::Zero();
  Eigen::Matrix4f light_from_world_ = Eigen::Matrix4f::Identity();
  float light_radius_m_ = 1.0f;
};

}  // namespace dance
