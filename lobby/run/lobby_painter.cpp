#include "lobby/run/lobby_painter.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lobby/screen/lobby_screens.h"
#include "viewer/overlay/overlay_fonts.h"

namespace dance {
namespace {

// Letters of western Europe, and the marks of good typography.
constexpr std::array<ImWchar, 7> kLetters{0x0020, 0x00ff, 0x2010, 0x2026, 0x20ac, 0x20ac, 0};

ImFont* add_font(ImFontAtlas& atlas, float size_px) {
  const char* file = find_overlay_font();
  ImFont* font = file == nullptr ? nullptr
                                 : atlas.AddFontFromFileTTF(file, std::round(size_px), nullptr,
                                                            kLetters.data());
  return font != nullptr ? font : atlas.AddFontDefault();
}

}  // namespace

Result<std::unique_ptr<LobbyPainter>> LobbyPainter::create(float scale) {
  std::unique_ptr<LobbyPainter> painter(new LobbyPainter(scale));
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigInputTextCursorBlink = false;  // it would cost pictures in an idle window
  painter->make_fonts();
  if (!ImGui_ImplOpenGL3_Init("#version 330 core"))
    return fail("text cannot be drawn: ImGui finds no OpenGL; install libgl1 with apt-get");
  painter->backend_started_ = true;
  return painter;
}

LobbyPainter::~LobbyPainter() {
  if (backend_started_) ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void LobbyPainter::make_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  fonts_.body = add_font(atlas, kLobbyBody_u * scale_);
  fonts_.title = add_font(atlas, kLobbyTitle_u * scale_);
  fonts_.small = add_font(atlas, kLobbySmall_u * scale_);
}

void LobbyPainter::set_scale(float scale) {
  if (std::abs(scale - scale_) < 0.01f) return;
  scale_ = scale;
  make_fonts();
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void LobbyPainter::draw(LobbyModel& model, int width_px, int height_px, Duration since_last,
                        std::vector<std::string>* clipped) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width_px), static_cast<float>(height_px));
  io.DeltaTime = std::clamp(static_cast<float>(since_last.as_seconds()), 1e-3f, 0.1f);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  LobbyKit kit(fonts_, scale_, clipped);
  draw_lobby(model, kit, io.DisplaySize.x, io.DisplaySize.y);
  ImGui::Render();
  glViewport(0, 0, width_px, height_px);
  glClearColor(0.075f, 0.082f, 0.106f, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glUseProgram(0);  // ImGui would put back one that has been deleted meanwhile
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
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
