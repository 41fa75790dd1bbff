// The panel under one half of a comparison: a ruler of the beats that this house hears, running
// with the music, under it a row for each dancer with a dot where each of the dancer's own beats
// was shown, a ring where it was predicted, and how far off that is.
//
// Units/frames: pixels from the top left; beats of this house's music; ms.
// Ownership:    borrows list and fonts.
// Threads:      the one whose OpenGL context is current.
// Failure:      without music it says so and draws no ruler.
#pragma once

#include "viewer/scene/scene.h"

struct ImDrawList;
struct ImFont;

namespace dance {

struct PanelFonts {
  ImFont* title;
  ImFont* text;
};

struct PanelBox {
  float left, top, right, bottom;
};

void draw_beat_panel(ImDrawList& list, const PanelFonts& fonts, const SceneState& scene,
                     const PanelBox& box, const char* title);

}  // namespace dance
