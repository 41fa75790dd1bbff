// StagePainter: the stage and what is written over it, as one picture. A window shows that picture
// and a headless run writes it to a file.
//
// Units/frames: W; pixels.
// Ownership:    owns renderer and overlay; the OpenGL context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() and draw() name what the driver refuses.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "viewer/gl/picture.h"
#include "viewer/overlay/overlay.h"
#include "viewer/scene/stage_picture.h"
#include "viewer/stage/stage_renderer.h"

namespace dance {

class StagePainter {
 public:
  static Result<std::unique_ptr<StagePainter>> create(Quality quality, float scale);

  // Of the pictures that follow. Which stage it is, whose eyes are looked through and whether hands
  // have trails is told by the scene too.
  void set_look(const StageLook& look) { look_ = look; }
  // Sets the place of all following pictures; kPlain leaves the place of their look.
  void set_place(Venue place) { place_ = place; }
  // Draws the following pictures of one stage with that share of the width and height and enlarges
  // them; text over them stays sharp. 1 = all pixels.
  void set_render_scale(float scale) { render_scale_ = scale; }

  // A mirrored camera's picture is turned round before names are written on it.
  Result<void> draw(const SceneState& scene, const OrbitCamera& camera, int width_px, int height_px,
                    const OverlayChoice& choice);
  // Several stages, each in its place; panels over all of it.
  Result<void> draw(std::span<const StageCell> cells, int width_px, int height_px,
                    const OverlayChoice& choice);
  // Two halves from one camera, the beats under each.
  Result<void> draw(const Comparison& comparison, const OrbitCamera& camera, int width_px,
                    int height_px, const OverlayChoice& choice);
  // Of each half's stage, for the camera.
  float aspect_of_half(int width_px, int height_px) const;
  // The picture that draw() has made.
  Picture read() const;
  // Copies it to the window's own framebuffer.
  void present() const;

  StageRenderer& renderer() { return *renderer_; }
  Overlay& overlay() { return *overlay_; }

 private:
  StagePainter() = default;
  StageLook look_of(const SceneState& scene) const;
  void find_tag_anchors(const SceneState& scene);
  void resize_wide(int width_px, int height_px);
  void copy_half(int left_px, int bottom_px) const;
  void clear_wide() const;
  void copy_into_wide(int width_px, int height_px, bool is_mirrored);
  Result<void> draw_stage(const SceneState& scene, const OrbitCamera& camera, int width_px,
                          int height_px, const OverlayChoice& choice, float render_scale);
  GLuint finished() const {
    return is_wide_ ? wide_.name() : renderer_->target().finished().name();
  }

  GlTexture wide_texture_;  // both halves
  GlFramebuffer wide_;
  int wide_width_px_ = 0, wide_height_px_ = 0;
  bool is_wide_ = false;  // of the last draw()
  float render_scale_ = 1.0f;
  StageLook look_;
  Venue place_ = Venue::kPlain;
  std::vector<Eigen::Vector3f> tag_anchors_W_m_;
  std::unique_ptr<StageRenderer> renderer_;
  std::unique_ptr<Overlay> overlay_;
};

}  // namespace dance
