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

// Where `letters` is nullptr, those of Latin-1; nullptr where there is no DejaVu font.
ImFont* add_dejavu(ImFontAtlas& atlas, float size_px, const ImWchar* letters) {
  const char* file = find_overlay_font();
  return file == nullptr ? nullptr
                         : atlas.AddFontFromFileTTF(file, std::round(size_px), nullptr, letters);
}

}  // namespace

const char* find_overlay_font() {
  for (const char* file : kFonts) {
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return file;
  }
  return nullptr;
}

ImFont* add_overlay_font(ImFontAtlas& atlas, float size_px) {
  ImFont* font = add_dejavu(atlas, size_px, nullptr);
  return font != nullptr ? font : atlas.AddFontDefault();
}

ImFont* add_text_font(ImFontAtlas& atlas, float size_px) {
  static constexpr std::array<ImWchar, 7> kLetters{0x0020, 0x00ff, 0x2010, 0x2026,
                                                   0x20ac, 0x20ac, 0};
  ImFont* font = add_dejavu(atlas, size_px, kLetters.data());
  return font != nullptr ? font : atlas.AddFontDefault();
}

ImFont* add_digit_font(ImFontAtlas& atlas, float size_px) {
  static constexpr std::array<ImWchar, 3> kDigits{'0', '9', 0};
  return add_dejavu(atlas, size_px, kDigits.data());
}

}  // namespace dance
