// What the timeline is drawn with: its colours, its buttons and their signs, which are drawn, as no
// font has all of them.
//
// Units/frames: pixels from the top left.
// Ownership:    borrows list and font for one picture.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include <algorithm>

#include "viewer/instruments/panel_ink.h"
#include "viewer/replay/timeline/timeline_panel.h"

namespace dance {

constexpr ImU32 kAccent = ink_of(0x5fb0ff);
constexpr ImU32 kDensity = ink_of(0x7f93b8, 70);
constexpr ImU32 kBarTick = ink_of(0xe6eaf4, 170);
constexpr ImU32 kBeatTick = ink_of(0xe6eaf4, 80);
constexpr ImU32 kLoopOn = ink_of(0x5fb0ff, 70);
constexpr ImU32 kLoopOff = ink_of(0x9aa3b5, 46);
constexpr ImU32 kLoopEdge = ink_of(0x8cc8ff, 220);
constexpr ImU32 kLapse = ink_of(0xff6b57, 235);
constexpr ImU32 kTimelinePaper = ink_of(0x0d1018, 205);

enum class Icon {
  kStart,
  kBack,
  kFrameBack,
  kPlay,
  kPause,
  kFrameOn,
  kOn,
  kLoopBegin,
  kLoopEnd,
  kLoop,
  kMinus,
  kPlus,
  kExport,
};

inline float letter_height(const PanelFrame& frame) {
  return frame.small_font != nullptr ? frame.small_font->FontSize : 14.0f * frame.scale;
}

constexpr std::size_t kMostRows = 6;  // of guests

// Where things are, from the top: what can be done, the bar, a row for each guest, times.
struct TimelinePanel::Box {
  Box(const PanelFrame& frame, float em, std::size_t guests) {
    const float margin = 0.8f * em;
    rows = std::min(guests, kMostRows);
    has_more = guests > kMostRows;
    row = 1.15f * em;
    const float rows_height = row * static_cast<float>(rows + (has_more ? 1 : 0));
    const float height = 0.6f * em + 2.0f * em + 2.6f * em + rows_height + 1.6f * em + 0.3f * em;
    left = margin;
    right = frame.width_px - margin;
    bottom = frame.height_px - margin;
    top = bottom - height;
    bar_left = left + std::min(9.0f * em, 0.2f * (right - left));
    bar_right = right - 1.2f * em;
    controls = top + 0.6f * em;
    bar = controls + 2.2f * em;
    bar_bottom = bar + 2.2f * em;
    guest_rows = bar_bottom + 0.25f * em;
    times = guest_rows + rows_height + 0.2f * em;
  }
  float left, right, top, bottom, bar_left, bar_right, controls, bar, bar_bottom, guest_rows, row,
      times;
  std::size_t rows = 0;
  bool has_more = false;
};

struct TimelinePanel::Ink : PanelInk {
  void panel(ImVec2 low, ImVec2 high) const {
    list().AddRectFilled(low, high, kTimelinePaper, 0.6f * em());
  }
  void bar(ImVec2 low, ImVec2 high, ImU32 colour) const {
    list().AddRectFilled(low, high, colour, 0.2f * em());
  }
  void middle(float x, float y, ImU32 colour, const char* words) const {
    left(x - 0.5f * width_of(words), y, colour, words);
  }
  void clipped(float from, float to, float y, ImU32 colour, const char* words) const {
    list().PushClipRect({from, y - em()}, {to, y + 2.0f * em()}, true);
    left(from, y, colour, words);
    list().PopClipRect();
  }
  // A button of 1.8 letters; true when it was pressed.
  bool button(const char* name, ImVec2 at, Icon icon, bool is_on) const;
  void sign(Icon icon, ImVec2 middle, ImU32 colour) const;
};

}  // namespace dance
