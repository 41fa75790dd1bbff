#include "viewer/stage/stage_painter.h"

namespace dance {

Result<std::unique_ptr<StagePainter>> StagePainter::create(Quality quality, float scale) {
  std::unique_ptr<StagePainter> painter(new StagePainter);
  DANCE_TRY(painter->renderer_, StageRenderer::create(quality));
  DANCE_TRY(painter->overlay_, Overlay::create(scale));
  return painter;
}

Result<void> StagePainter::draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                                int height_px, const OverlayChoice& choice) {
  return draw_stage(scene, camera, width_px, height_px, choice, look_);
}

Result<void> StagePainter::draw_stage(const SceneState& scene, const OrbitCamera& camera,
                                      int width_px, int height_px, const OverlayChoice& choice,
                                      const StageLook& look) {
  is_wide_ = false;
  renderer_->set_look(look);
  if (auto drawn = renderer_->draw(scene, camera, width_px, height_px); !drawn) return drawn;
  find_tag_anchors(scene);
  OverlayChoice with_anchors = choice;
  with_anchors.tag_anchors_W_m = tag_anchors_W_m_;
  overlay_->draw(scene, camera, width_px, height_px, with_anchors);
  return {};
}

// Over the head of the figure; of a guest without one, over the dancer's.
void StagePainter::find_tag_anchors(const SceneState& scene) {
  tag_anchors_W_m_.clear();
  auto figure = renderer_->figures().begin();
  const auto end = renderer_->figures().end();
  for (const SceneGuest& guest : scene.guests) {
    const bool has_figure = figure != end && figure->id == guest.id;
    tag_anchors_W_m_.push_back(has_figure ? tag_anchor_W_m(figure->frames) : tag_anchor_W_m(guest));
    if (has_figure) ++figure;
  }
}

float StagePainter::aspect_of_half(int width_px, int height_px) const {
  return static_cast<float>(width_px / 2) /
         static_cast<float>(height_px - overlay_->panel_height_px(height_px));
}

Result<void> StagePainter::draw(const Comparison& comparison, const OrbitCamera& camera,
                                int width_px, int height_px, const OverlayChoice& choice) {
  resize_wide(width_px, height_px);
  const int panel_px = overlay_->panel_height_px(height_px);
  const int half_px = width_px / 2;
  OverlayChoice words = choice;
  words.hud = false;       // the beat panels have the figures
  words.panels = nullptr;  // drawn once, over both halves
  for (const SceneState* scene : {&comparison.raw, &comparison.shown}) {
    StageLook look = look_;
    if (scene == &comparison.raw) look.stage = -1 - look_.stage;
    if (auto drawn = draw_stage(*scene, camera, half_px, height_px - panel_px, words, look); !drawn)
      return drawn;
    copy_half(scene == &comparison.raw ? 0 : width_px - half_px, panel_px);
  }
  is_wide_ = true;
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.name());
  glViewport(0, 0, width_px, height_px);
  overlay_->draw_beats(comparison, width_px, height_px, choice.panels);
  return {};
}

void StagePainter::resize_wide(int width_px, int height_px) {
  if (wide_width_px_ == width_px && wide_height_px_ == height_px) return;
  wide_texture_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, wide_texture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_px, height_px, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  wide_ = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, wide_texture_.name(),
                         0);
  wide_width_px_ = width_px;
  wide_height_px_ = height_px;
  check_gl("StagePainter::resize_wide");
}

void StagePainter::copy_half(int left_px, int bottom_px) const {
  const PictureTarget& half = renderer_->target();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, half.finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, wide_.name());
  glBlitFramebuffer(0, 0, half.width_px(), half.height_px(), left_px, bottom_px,
                    left_px + half.width_px(), bottom_px + half.height_px(), GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

Picture StagePainter::read() const {
  const PictureTarget& target = renderer_->target();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, finished());
  return is_wide_ ? read_bound_framebuffer(wide_width_px_, wide_height_px_)
                  : read_bound_framebuffer(target.width_px(), target.height_px());
}

void StagePainter::present() const {
  const PictureTarget& target = renderer_->target();
  const int width_px = is_wide_ ? wide_width_px_ : target.width_px();
  const int height_px = is_wide_ ? wide_height_px_ : target.height_px();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, finished());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width_px, height_px, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  check_gl("StagePainter::present");
}

}  // namespace dance
