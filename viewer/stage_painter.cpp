#include "viewer/stage_painter.h"

namespace dance {

Result<std::unique_ptr<StagePainter>> StagePainter::create(Quality quality, float scale) {
  std::unique_ptr<StagePainter> painter(new StagePainter);
  DANCE_TRY(painter->renderer_, StageRenderer::create(quality));
  DANCE_TRY(painter->overlay_, Overlay::create(scale));
  return painter;
}

Result<void> StagePainter::draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                                int height_px, const OverlayChoice& choice) {
  if (auto drawn = renderer_->draw(scene, camera, width_px, height_px); !drawn) return drawn;
  overlay_->draw(scene, camera, width_px, height_px, choice);
  return {};
}

Picture StagePainter::read() const {
  const PictureTarget& target = renderer_->target();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.finished().name());
  return read_bound_framebuffer(target.width_px(), target.height_px());
}

void StagePainter::present() const {
  const PictureTarget& target = renderer_->target();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target.finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, target.width_px(), target.height_px(), 0, 0, target.width_px(),
                    target.height_px(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
  check_gl("StagePainter::present");
}

}  // namespace dance
