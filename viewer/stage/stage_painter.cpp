#include "viewer/stage/stage_painter.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

int scaled_px(int px, float scale) {
  return std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(px))));
}

}  // namespace

Result<std::unique_ptr<StagePainter>> StagePainter::create(Quality quality, float scale) {
  std::unique_ptr<StagePainter> painter(new StagePainter);
  DANCE_TRY(painter->renderer_, StageRenderer::create(quality));
  DANCE_TRY(painter->overlay_, Overlay::create(scale));
  return painter;
}

StageLook StagePainter::look_of(const SceneState& scene) const {
  StageLook look = look_;
  if (place_ != Venue::kPlain) look.place = place_;
  look.trails = look.trails || scene.shows_trails;
  look.stage += scene.stage;
  for (const SceneGuest& guest : scene.guests)
    if (guest.hides_head) look.through_eyes_of = guest.id;
  return look;
}

Result<void> StagePainter::draw(const SceneState& scene, const OrbitCamera& camera, int width_px,
                                int height_px, const OverlayChoice& choice) {
  return draw_stage(scene, camera, width_px, height_px, choice, render_scale_);
}

Result<void> StagePainter::draw_stage(const SceneState& scene, const OrbitCamera& camera,
                                      int width_px, int height_px, const OverlayChoice& choice,
                                      float render_scale) {
  is_wide_ = false;
  renderer_->set_look(look_of(scene));
  if (auto drawn = renderer_->draw(scene, camera, scaled_px(width_px, render_scale),
                                   scaled_px(height_px, render_scale));
      !drawn)
    return drawn;
  if (camera.is_mirrored || render_scale != 1.0f)
    copy_into_wide(width_px, height_px, camera.is_mirrored);
  find_tag_anchors(scene);
  OverlayChoice with_anchors = choice;
  with_anchors.tag_anchors_W_m = tag_anchors_W_m_;
  overlay_->draw(scene, camera, width_px, height_px, with_anchors);
  return {};
}

Result<void> StagePainter::draw(std::span<const StageCell> cells, int width_px, int height_px,
                                const OverlayChoice& choice) {
  if (cells.size() == 1) {
    renderer_->set_light_yaw(cells.front().light_yaw_rad);
    return draw(*cells.front().scene, cells.front().camera, width_px, height_px, choice);
  }
  resize_wide(width_px, height_px);
  clear_wide();
  OverlayChoice words;
  words.tags = choice.tags;
  words.hud = false;  // no room in a cell
  for (const StageCell& cell : cells) {
    renderer_->set_light_yaw(cell.light_yaw_rad);
    if (auto drawn = draw_stage(*cell.scene, cell.camera, cell.box.width_px, cell.box.height_px,
                                words, 1.0f);
        !drawn)
      return drawn;
    copy_half(cell.box.left_px, height_px - cell.box.top_px - cell.box.height_px);
  }
  is_wide_ = true;
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.name());
  glViewport(0, 0, width_px, height_px);
  overlay_->draw_frames(cells, width_px, height_px, choice);
  return {};
}

void StagePainter::clear_wide() const {
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.name());
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.02f, 0.022f, 0.03f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
}

void StagePainter::copy_into_wide(int width_px, int height_px, bool is_mirrored) {
  const PictureTarget& from = renderer_->target();
  const bool is_same_size = from.width_px() == width_px && from.height_px() == height_px;
  resize_wide(width_px, height_px);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer_->target().finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, wide_.name());
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, from.width_px(), from.height_px(), is_mirrored ? width_px : 0, 0,
                    is_mirrored ? 0 : width_px, height_px, GL_COLOR_BUFFER_BIT,
                    is_same_size ? GL_NEAREST : GL_LINEAR);
  is_wide_ = true;
  glBindFramebuffer(GL_FRAMEBUFFER, wide_.name());
  glViewport(0, 0, width_px, height_px);
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
    if (auto drawn = draw_stage(*scene, camera, half_px, height_px - panel_px, words, 1.0f); !drawn)
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
