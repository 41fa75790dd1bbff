// The font of all text in pictures: DejaVu Sans where this machine has it, else ImGui's own, which
// is coarse.
//
// Units/frames: sizes in pixels.
// Ownership:    the atlas owns its fonts.
// Threads:      the one whose ImGui context is current.
// Failure:      find_overlay_font() is nullopt where there is no DejaVu font.
#pragma once

struct ImFont;
struct ImFontAtlas;

namespace dance {

const char* find_overlay_font();
// With the letters of western Europe and the marks of good typography.
ImFont* add_text_font(ImFontAtlas& atlas, float size_px);
ImFont* add_overlay_font(ImFontAtlas& atlas, float size_px);
// The ten digits alone; nullptr where there is no DejaVu font.
ImFont* add_digit_font(ImFontAtlas& atlas, float size_px);

}  // namespace dance
