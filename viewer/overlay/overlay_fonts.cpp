#include "viewer/overlay/overlay_fonts.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <filesystem>

namespace dance {
namespace {

constexpr std::array<const char*, 3> kFonts{"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                            "/usr/share/fonts/TTF/DejaVuSans.ttf",
                                            "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};

}  // namespace

const char* find_overlay_font() {
  for (const char* file : kFonts) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return file;
  }
  return nullptr;
}

ImFont* add_overlay_font(ImFontAtlas& atlas, float size_px) {
  if (const char* file = find_overlay_font())
    if (ImFont* font = atlas.AddFontFromFileTTF(file, std::round(size_px))) return font;
  return atlas.AddFontDefault();
}

ImFont* add_digit_font(ImFontAtlas& atlas, float size_px) {
  static constexpr std::array<ImWchar, 3> kDigits{'0', '9', 0};
  if (const char* file = find_overlay_font())
    if (ImFont* font = atlas.AddFontFromFileTTF(file, std::round(size_px), nullptr, kDigits.data()))
      return font;
  return nullptr;
}

}  // namespace dance
