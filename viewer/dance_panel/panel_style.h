// Shapes, texts and layout of the dance panel.
//
// Units/frames: pixels.
// Ownership:    constants; draws on lists of the caller's.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "viewer/dance_panel/quality.h"
#include "viewer/panel/panel_colours.h"

namespace dance::panel_style {

using namespace panel_colours;

inline ImU32 colour_of(QualityLevel level) {
  return level == QualityLevel::kGood ? kGood : level == QualityLevel::kFair ? kFair : kBad;
}

// Round, three-cornered and square: told apart without colours, too.
inline void draw_quality(ImDrawList& list, QualityLevel level, ImVec2 centre, float radius) {
  const ImU32 colour = colour_of(level);
  if (level == QualityLevel::kGood)
    list.AddCircleFilled(centre, radius, colour, 20);
  else if (level == QualityLevel::kFair)
    list.AddTriangleFilled({centre.x, centre.y - 1.15f * radius},
                           {centre.x + 1.15f * radius, centre.y + 0.9f * radius},
                           {centre.x - 1.15f * radius, centre.y + 0.9f * radius}, colour);
  else
    list.AddRectFilled({centre.x - 0.95f * radius, centre.y - 0.95f * radius},
                       {centre.x + 0.95f * radius, centre.y + 0.95f * radius}, colour);
}

// How loud: 0 to 1.
inline void draw_level(ImDrawList& list, ImVec2 low, ImVec2 size, float level, ImU32 colour) {
  const float radius = 0.5f * size.y;
  list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, kTrough, radius);
  const float filled = std::clamp(level, 0.0f, 1.0f) * size.x;
  if (filled > 1.0f)
    list.AddRectFilled(low, {low.x + std::max(filled, size.y), low.y + size.y}, colour, radius);
}

// The text, cut and with "..." at its end if it is wider. Names are plain letters.
inline std::string fitted(std::string_view text, float width) {
  std::string whole(text);
  if (ImGui::CalcTextSize(whole.c_str()).x <= width) return whole;
  while (!whole.empty() && ImGui::CalcTextSize((whole + "...").c_str()).x > width) {
    whole.pop_back();
    // Not within a letter of several bytes.
    while (!whole.empty() && (static_cast<unsigned char>(whole.back()) & 0xc0u) == 0x80u)
      whole.pop_back();
    if (!whole.empty() && (static_cast<unsigned char>(whole.back()) & 0xc0u) == 0xc0u)
      whole.pop_back();
  }
  return whole + "...";
}

inline void text(ImU32 colour, const char* words) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(words);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

inline float wrapped_height(const std::string& words, float width) {
  return ImGui::CalcTextSize(words.c_str(), nullptr, false, width).y;
}

// The column's width.
inline float column_width(float em, float window_px) {
  return std::min(21.5f * em, 0.36f * window_px);
}

constexpr ImGuiWindowFlags kWindow =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
    ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar |
    ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoFocusOnAppearing;

// A background below content whose height is known only after it is drawn.
class PanelBackground {
 public:
  explicit PanelBackground(float width) : list_(*ImGui::GetWindowDrawList()), width_(width) {
    list_.ChannelsSplit(2);
    list_.ChannelsSetCurrent(1);
  }
  void end(float height, ImU32 colour, float radius) {
    list_.ChannelsSetCurrent(0);
    const ImVec2 low = ImGui::GetWindowPos();
    list_.PushClipRectFullScreen();
    list_.AddRectFilled(low, {low.x + width_, low.y + height}, colour, radius);
    list_.PopClipRect();
    list_.ChannelsMerge();
  }

 private:
  ImDrawList& list_;
  float width_;
};

// "0:07", "1:02:03".
inline std::string clock_text(Duration elapsed) {
  const std::int64_t seconds = elapsed.count_ms() / 1000;
  return seconds < 3600
             ? fmt::format("{}:{:02}", seconds / 60, seconds % 60)
             : fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

}  // namespace dance::panel_style
