#include "viewer/instruments/latency_bar.h"

#include <algorithm>
#include <array>

namespace dance {
namespace {

struct Stage {
  const char* words;
  unsigned rgb;
};

// In the order of the gaps. Neighbours differ in hue and lightness.
constexpr std::array<Stage, kGapCount> kStages{{
    {"capture", 0x4f8fe6},
    {"to link", 0x9fd6f2},
    {"to server", 0xf0b43c},
    {"to house", 0xd9653b},
    {"stage waits", 0x8f6fd8},
    {"staged", 0xdda6e8},
    {"to viewer", 0x3fa37c},
    {"to screen", 0xb9e08a},
}};
constexpr ImU32 kMark = ink_of(0xffffff);

float known(float ms) { return std::isfinite(ms) ? std::max(ms, 0.0f) : 0.0f; }

}  // namespace

float bar_scale_ms(float longest_ms) {
  for (const float scale : {20.0f, 50.0f, 100.0f, 200.0f, 300.0f, 500.0f, 1000.0f, 2000.0f})
    if (longest_ms <= scale) return scale;
  return 5000.0f;
}

void draw_latency_bar(const PanelInk& ink, const GuestStats& stats, const BarBox& box,
                      float scale_ms) {
  const float px_per_ms = (box.right - box.left) / scale_ms;
  const auto at = [&](float ms) { return std::min(box.left + ms * px_per_ms, box.right); };
  ink.list().AddRectFilled({box.left, box.top}, {box.right, box.bottom}, ink_of(0xffffff, 16));
  float so_far_ms = 0.0f;
  for (std::size_t gap = 0; gap < kGapCount; ++gap) {
    const float ms = known(stats.gap_p50_ms[gap]);
    if (ms <= 0.0f) continue;
    ink.list().AddRectFilled({at(so_far_ms), box.top}, {at(so_far_ms + ms), box.bottom},
                             ink_of(kStages[gap].rgb));
    so_far_ms += ms;
  }
  const float middle = 0.5f * (box.top + box.bottom);
  if (const float p99 = known(stats.newest_p99_ms); p99 > so_far_ms) {
    ink.list().AddLine({at(so_far_ms), middle}, {at(p99), middle}, kDim, 1.0f);
    ink.list().AddLine({at(p99), box.top + 2.0f}, {at(p99), box.bottom - 2.0f}, kDim, 1.0f);
  }
  if (!std::isfinite(stats.age_p50_ms)) return;
  // Where the moment that is shown was danced.
  const float x = std::clamp(box.left + stats.age_p50_ms * px_per_ms, box.left, box.right);
  ink.list().AddRectFilled({x - 2.0f, box.top - 2.0f}, {x + 2.0f, box.bottom + 2.0f},
                           ink_of(0x0d1018));
  ink.list().AddRectFilled({x - 1.0f, box.top - 2.0f}, {x + 1.0f, box.bottom + 2.0f}, kMark);
}

void draw_bar_ticks(const PanelInk& ink, const BarBox& box, float scale_ms) {
  const int ticks = box.right - box.left > 9.0f * ink.em() ? 2 : 1;
  for (int i = 0; i <= ticks; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(ticks);
    char words[24];
    std::snprintf(words, sizeof words, i == ticks ? "%.0f ms" : "%.0f",
                  static_cast<double>(share * scale_ms));
    const float x = box.left + share * (box.right - box.left);
    const float width = ink.width_of(words);
    const float begin = i == 0 ? x : i == ticks ? x - width : x - 0.5f * width;
    ink.left(begin, box.top, kDim, words);
  }
}

void draw_gap_table(const PanelInk& ink, const GuestStats& stats, const BarBox& box) {
  constexpr std::size_t kAcross = 2, kDown = kGapCount / kAcross;
  const float em = ink.em(), gap = 0.9f * em;
  const float width = (box.right - box.left - gap) / kAcross;
  for (std::size_t column = 0; column < kAcross; ++column) {
    const float left = box.left + static_cast<float>(column) * (width + gap), right = left + width;
    ink.right(right - 2.6f * em, box.top, kDim, "p50 ms");
    ink.right(right, box.top, kDim, "p99");
    for (std::size_t row = 0; row < kDown; ++row) {
      const std::size_t stage = column * kDown + row;
      const float y = box.top + static_cast<float>(row + 1) * 1.3f * em;
      ink.list().AddRectFilled({left, y + 0.2f * em}, {left + 0.75f * em, y + 0.95f * em},
                               ink_of(kStages[stage].rgb));
      ink.left(left + 1.0f * em, y, kBright, kStages[stage].words);
      ink.number(right - 2.6f * em, y, kBright, "%.1f", stats.gap_p50_ms[stage]);
      ink.number(right, y, kDim, "%.1f", stats.gap_p99_ms[stage]);
    }
  }
}

float draw_bar_legend(const PanelInk& ink, float left, float top, float right) {
  const float em = ink.em();
  float x = left, y = top;
  const auto place = [&](const char* words, ImU32 colour, bool is_mark) {
    const float width = 1.0f * em + ink.width_of(words) + 0.9f * em;
    if (x > left && x + width - 0.9f * em > right) {
      x = left;
      y += 1.35f * em;
    }
    if (is_mark)
      ink.list().AddRectFilled({x + 0.3f * em, y}, {x + 0.3f * em + 2.0f, y + 1.1f * em}, colour);
    else
      ink.list().AddRectFilled({x, y + 0.2f * em}, {x + 0.75f * em, y + 0.95f * em}, colour);
    ink.left(x + 1.0f * em, y, kDim, words);
    x += width;
  };
  for (const Stage& stage : kStages) place(stage.words, ink_of(stage.rgb), false);
  place("moment shown", kMark, true);
  return y - top + 1.35f * em;
}

}  // namespace dance
