// StagePainter: the stage and what is written over it, as one picture. A window shows that picture
// and a headless run writes it to a file; there is no other way to either.
//
// Units/frames: W; pixels.
// Ownership:    owns renderer and overlay; the OpenGL context must outlive it.
// Threads:      the one whose context is current.
// Failure:      create() and draw() tell what the driver refuses.
#pragma once

#include <memory>

#include "viewer/overlay.h"
#include "viewer/picture.h"
#include "viewer/stage_renderer.h"

namespace dance {

class StagePainter {
 public:
  static Result<std::unique_ptr<StagePainter>> create(Quality quality, float scale);

  Result<void> draw(const SceneState& scene, const OrbitCamera& camera, int width_px, int height_px,
                    const OverlayChoice& choice);
  // The picture that draw() has made.
  Picture read() const;
  // Copies it to the window's own framebuffer.
  void present() const;

  StageRenderer& renderer() { return *renderer_; }
  Overlay& overlay() { return *overlay_; }

 private:
  StagePainter() = default;
  std::unique_ptr<StageRenderer> renderer_;
  std::unique_ptr<Overlay> overlay_;
};

}  // namespace dance
