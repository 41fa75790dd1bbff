#include "headset/stereo/stereo_painter.h"

#include <algorithm>

namespace dance {

using Eigen::Vector3f;

namespace {

// For all that is chosen once for both: between them.
StageEye middle_of(const std::array<StageEye, 2>& eyes) {
  StageEye middle = eyes[0];
  middle.eye_W_m = 0.5f * (eyes[0].eye_W_m + eyes[1].eye_W_m);
  return middle;
}

}  // namespace

Result<std::unique_ptr<StereoPainter>> StereoPainter::create(Quality quality, Language language) {
  DANCE_TRY(BoardPainter boards, BoardPainter::create());
  std::unique_ptr<StereoPainter> painter(new StereoPainter(std::move(boards)));
  DANCE_TRY(painter->renderer_, StageRenderer::create(quality));
  DANCE_TRY(painter->sheet_, BoardSheet::create(language));
  painter->renderer_->build_meshes_beside();
  painter->copy_ = GlFramebuffer::make();
  return painter;
}

// Over the head of the figure; of a guest without one, over the dancer's.
void StereoPainter::find_tag_anchors(const SceneState& scene) {
  tag_anchors_W_m_.clear();
  const auto figures = renderer_->figures();
  for (const SceneGuest& guest : scene.guests) {
    const auto figure = std::find_if(figures.begin(), figures.end(),
                                     [&](const PosedFigure& it) { return it.id == guest.id; });
    tag_anchors_W_m_.push_back(figure == figures.end() ? tag_anchor_W_m(guest)
                                                       : tag_anchor_W_m(figure->frames));
  }
}

Result<void> StereoPainter::prepare(SceneState& scene, const std::array<StageEye, 2>& eyes,
                                    int width_px, int height_px, const WristPanel& panel,
                                    const PanelWords& words, const StereoWishes& wishes) {
  eyes_ = eyes;
  width_px_ = width_px;
  height_px_ = height_px;
  darkness_ = wishes.darkness;
  const StageEye middle = middle_of(eyes);
  for (SceneGuest& guest : scene.guests) guest.hides_head = guest.id == wishes.own;
  keep_personal_space(wishes.comfort, middle.eye_W_m, wishes.own, scene.guests);
  StageLook look;
  look.place = wishes.place;
  look.trails = scene.shows_trails;
  look.through_eyes_of = wishes.own;
  look.floor = {middle.eye_W_m.x(), middle.eye_W_m.z(), wishes.comfort.floor_m};
  renderer_->set_look(look);
  if (auto prepared = renderer_->prepare(scene, middle, width_px, height_px); !prepared)
    return prepared;
  sheet_->draw(panel, words, scene.guests, scene.names);
  find_tag_anchors(scene);
  boards_.clear();
  if (wishes.tags) sheet_->append_tags(scene.guests, tag_anchors_W_m_, middle.eye_W_m, boards_);
  sheet_->append_panel(panel, boards_);
  renderer_->paint_shadows();
  return {};
}

void StereoPainter::paint(std::size_t eye) {
  renderer_->paint_eye(eyes_[eye], [this](const StageEye& from) {
    board_painter_.draw(from, boards_, sheet_->texture());
    board_painter_.darken(darkness_);
  });
}

void StereoPainter::copy_to(GLuint texture) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, copy_.name());
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  // Bytes as they are, which the texture's format says a screen shows: no conversion.
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
  check_gl("StereoPainter::copy_to");
}

void StereoPainter::show_in_window(int width_px, int height_px) const {
  if (width_px <= 0 || height_px <= 0 || width_px_ <= 0) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, finished().name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  // Fills the window, cut at its longer side: an eye's picture is nearly square.
  const float of_window = static_cast<float>(width_px) / static_cast<float>(height_px);
  const auto high =
      std::min(height_px_, static_cast<int>(static_cast<float>(width_px_) / of_window));
  const auto wide = std::min(width_px_, static_cast<int>(static_cast<float>(high) * of_window));
  const int left = (width_px_ - wide) / 2, low = (height_px_ - high) / 2;
  glBlitFramebuffer(left, low, left + wide, low + high, 0, 0, width_px, height_px,
                    GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace dance
