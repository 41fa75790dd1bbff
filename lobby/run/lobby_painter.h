// LobbyPainter: draws the window's screens: Dear ImGui's context with the lobby's fonts, and its
// way to OpenGL. The stage has a context of its own; one of the two lives at a time.
//
// Units/frames: pixels; `scale` is the monitor's (1 = 96 dpi).
// Ownership:    owns the ImGui context and its OpenGL objects; one per process.
// Threads:      the one whose OpenGL context is current.
// Failure:      create() tells when ImGui cannot start; without the DejaVu font it takes its own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "formats/camera_view/camera_view.h"
#include "lobby/screen/lobby_kit.h"
#include "lobby/screen/lobby_model.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/overlay/imgui_on_gl.h"

namespace dance {

class LobbyPainter {
 public:
  static Result<std::unique_ptr<LobbyPainter>> create(float scale);
  LobbyPainter(const LobbyPainter&) = delete;
  LobbyPainter& operator=(const LobbyPainter&) = delete;

  void set_scale(float scale);
  // Onto the bound framebuffer. Texts that do not fit go to `clipped`, if there is one.
  void draw(LobbyModel& model, int width_px, int height_px, Duration since_last,
            std::vector<std::string>* clipped = nullptr);
  // What draw_lobby() takes as the camera's picture.
  void* texture_of(const PreviewPicture& preview);
  bool is_typed_in() const;  // somebody types into a field just now

 private:
  explicit LobbyPainter(float scale) : scale_(scale) {}
  void make_fonts();

  ImguiOnGl imgui_;
  float scale_;
  LobbyFonts fonts_;
  GlTexture preview_;
};

}  // namespace dance
