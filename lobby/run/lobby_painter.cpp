#include "lobby/run/lobby_painter.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lobby/screen/lobby_screens.h"
#include "viewer/overlay/overlay_fonts.h"

namespace dance {
Result<std::unique_ptr<LobbyPainter>> LobbyPainter::create(float scale) {
  std::unique_ptr<LobbyPainter> painter(new LobbyPainter(scale));
  ImGui::GetIO().ConfigInputTextCursorBlink = false;  // it would cost pictures in an idle window
  painter->make_fonts();
  if (auto begun = painter->imgui_.begin("text"); !begun) return tl::make_unexpected(begun.error());
  return painter;
}

void LobbyPainter::make_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  fonts_.body = add_text_font(atlas, kLobbyBody_u * scale_);
  fonts_.title = add_text_font(atlas, kLobbyTitle_u * scale_);
  fonts_.small = add_text_font(atlas, kLobbySmall_u * scale_);
}

void LobbyPainter::set_scale(float scale) {
  if (std::abs(scale - scale_) < 0.01f) return;
  scale_ = scale;
  make_fonts();
  imgui_.renew_fonts();
}

void LobbyPainter::draw(LobbyModel& model, int width_px, int height_px, Duration since_last,
                        std::vector<std::string>* clipped) {
  imgui_.begin_frame(width_px, height_px,
                     std::clamp(static_cast<float>(since_last.as_seconds()), 1e-3f, 0.1f));
  LobbyKit kit(fonts_, scale_, clipped);
  draw_lobby(model, kit, static_cast<float>(width_px), static_cast<float>(height_px));
  glViewport(0, 0, width_px, height_px);
  glClearColor(0.075f, 0.082f, 0.106f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  imgui_.end_frame();
}

void* LobbyPainter::texture_of(const PreviewPicture& preview) {
  if (preview_.name() == 0) {
    preview_ = GlTexture::make();
    glBindTexture(GL_TEXTURE_2D, preview_.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  glBindTexture(GL_TEXTURE_2D, preview_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, preview.width, preview.height, 0, GL_RGB,
               GL_UNSIGNED_BYTE, preview.rgb.data());
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(preview_.name()));
}

bool LobbyPainter::is_typed_in() const { return ImGui::GetIO().WantTextInput; }

}  // namespace dance
