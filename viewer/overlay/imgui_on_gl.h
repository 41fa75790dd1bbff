// ImguiOnGl: a context of Dear ImGui that draws onto the bound framebuffer.
//
// Units/frames: pixels from the top left.
// Ownership:    owns the context and its OpenGL objects; one lives at a time, as ImGui has one.
// Threads:      the one whose OpenGL context is current.
// Failure:      begin() tells when ImGui cannot start.
#pragma once

#include "core/base/result.h"

namespace dance {

class ImguiOnGl {
 public:
  ImguiOnGl();
  ~ImguiOnGl();
  ImguiOnGl(const ImguiOnGl&) = delete;
  ImguiOnGl& operator=(const ImguiOnGl&) = delete;

  // When its fonts are there; `what` it is to draw stands in the error.
  Result<void> begin(const char* what);
  // They are others now.
  void renew_fonts();

  void begin_frame(int width_px, int height_px, float since_last_s = 1.0f / 60.0f);
  void end_frame();

 private:
  bool has_begun_ = false;
};

}  // namespace dance
