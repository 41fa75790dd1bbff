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

// nullptr where there is no DejaVu font.
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
  // Latin, Greek and Cyrillic for chat and names; dashes, and the arrows of keys.
  static constexpr std::array<ImWchar, 11> kLetters{0x0020, 0x024f, 0x0370, 0x052f, 0x2010, 0x2026,
                                                    0x20ac, 0x20ac, 0x2190, 0x2193, 0};
  ImFont* font = add_dejavu(atlas, size_px, kLetters.data());
  return font != nullptr ? font : atlas.AddFontDefault();
}

ImFont* add_text_font(ImFontAtlas& atlas, float size_px) {
  // Latin, and the commonly used Greek and Cyrillic letters, for names.
  static constexpr std::array<ImWchar, 11> kLetters{0x0020, 0x024f, 0x0386, 0x03ce, 0x0400, 0x04ff,
                                                    0x2010, 0x2026, 0x20ac, 0x20ac, 0};
  ImFont* font = add_dejavu(atlas, size_px, kLetters.data());
  return font != nullptr ? font : atlas.AddFontDefault();
}

ImFont* add_digit_font(ImFontAtlas& atlas, float size_px) {
  static constexpr std::array<ImWchar, 3> kDigits{'0', '9', 0};
  return add_dejavu(atlas, size_px, kDigits.data());
}

}  // namespace dance
