// PanelInk: words and colours of the instruments, in one size of one font.
//
// Units/frames: pixels from the top left.
// Ownership:    borrows list and font for one picture.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include <imgui.h>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string>

namespace dance {

constexpr ImU32 ink_of(unsigned rgb, unsigned alpha = 255) {
  return IM_COL32((rgb >> 16) & 255u, (rgb >> 8) & 255u, rgb & 255u, alpha);
}
constexpr ImU32 kBright = ink_of(0xf4f5f9);
constexpr ImU32 kDim = ink_of(0xa7adbd);
constexpr ImU32 kFaint = ink_of(0xffffff, 34);
constexpr ImU32 kPaper = ink_of(0x0d1018, 251);
constexpr ImU32 kChosen = ink_of(0x3d6fb5, 120);
constexpr ImU32 kWarning = ink_of(0xffb454);

class PanelInk {
 public:
  PanelInk(ImDrawList& list, ImFont& font) : list_(list), font_(font), size_(font.FontSize) {}

  ImDrawList& list() const { return list_; }
  ImFont& font() const { return font_; }
  float em() const { return size_; }
  float width_of(const char* words) const {
    return font_.CalcTextSizeA(size_, 1e5f, 0.0f, words).x;
  }
  // On whole pixels, where text is sharp.
  void left(float x, float y, ImU32 colour, const char* words) const {
    list_.AddText(&font_, size_, {std::round(x), std::round(y)}, colour, words);
  }
  void right(float x, float y, ImU32 colour, const char* words) const {
    left(x - width_of(words), y, colour, words);
  }
  // A number, or a dash where it is not known.
  void number(float x, float y, ImU32 colour, const char* format, float value) const {
    char words[32];
    std::snprintf(words, sizeof words, format, static_cast<double>(value));
    right(x, y, std::isfinite(value) ? colour : kDim, std::isfinite(value) ? words : "-");
  }

 private:
  ImDrawList& list_;
  ImFont& font_;
  float size_;
};

}  // namespace dance
