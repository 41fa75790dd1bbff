#include "viewer/dance_panel/panel_controls.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr int kScrolledTo = 12;
constexpr ImU32 kFillInk = IM_COL32(61, 111, 181, 255);
constexpr ImU32 kFocusInk = IM_COL32(255, 255, 255, 230);

struct LookColours {
  ImU32 rest, over, pressed;
};
LookColours colours_of(PanelControls::Look look) {
  switch (look) {
    case PanelControls::Look::kStrong:
      return {IM_COL32(61, 111, 181, 255), IM_COL32(78, 132, 206, 255), IM_COL32(50, 96, 160, 255)};
    case PanelControls::Look::kWarning:
      return {IM_COL32(158, 58, 52, 255), IM_COL32(186, 72, 64, 255), IM_COL32(132, 48, 43, 255)};
    case PanelControls::Look::kQuiet:
      return {IM_COL32(255, 255, 255, 0), IM_COL32(255, 255, 255, 28), IM_COL32(255, 255, 255, 18)};
    case PanelControls::Look::kPlain:
      break;
  }
  return {IM_COL32(52, 60, 78, 255), IM_COL32(68, 78, 100, 255), IM_COL32(44, 51, 66, 255)};
}

}  // namespace

bool PanelControls::on_key(const KeyPress& press) {
  if (press.has_control) return false;
  const bool is_back = press.key == GLFW_KEY_UP || (press.key == GLFW_KEY_TAB && press.has_shift);
  const bool is_on = press.key == GLFW_KEY_DOWN || (press.key == GLFW_KEY_TAB && !press.has_shift);
  if (is_back || is_on) {
    const auto at = std::find(last_order_.begin(), last_order_.end(), focus_);
    if (last_order_.empty()) return true;
    if (!has_keyboard_ || at == last_order_.end())
      focus_ = is_on ? last_order_.front() : last_order_.back();
    else if (is_on)
      focus_ = at + 1 == last_order_.end() ? last_order_.front() : *(at + 1);
    else
      focus_ = at == last_order_.begin() ? last_order_.back() : *(at - 1);
    has_keyboard_ = true;
    scrolls_ = kScrolledTo;
    return true;
  }
  if (press.key == GLFW_KEY_LEFT || press.key == GLFW_KEY_RIGHT) {
    if (has_keyboard_) steps_ += press.key == GLFW_KEY_RIGHT ? 1 : -1;
    return true;
  }
  const bool is_enter =
      press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER || press.key == GLFW_KEY_SPACE;
  if (!is_enter || !has_keyboard_) return false;
  if (!press.is_repeat) is_pressed_ = true;
  return true;
}

void PanelControls::begin() {
  order_.clear();
  // The mouse takes over.
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) has_keyboard_ = false;
}

void PanelControls::end() {
  std::swap(order_, last_order_);
  const auto at = std::find(last_order_.begin(), last_order_.end(), focus_);
  if (at != last_order_.end())
    place_ = static_cast<std::size_t>(at - last_order_.begin());
  else
    focus_ = has_keyboard_ && !last_order_.empty()
                 ? last_order_[std::min(place_, last_order_.size() - 1)]
                 : 0;
  is_pressed_ = false;
  scrolls_ = std::max(0, scrolls_ - 1);
  steps_ = 0;
}

bool PanelControls::settle(ImGuiID id) {
  if (order_.size() < kMost) order_.push_back(id);
  if (!has_keyboard_ || focus_ != id) return false;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float line = std::max(1.0f, 0.1f * ImGui::GetFontSize());
  ImGui::GetWindowDrawList()->AddRect({low.x - line, low.y - line}, {high.x + line, high.y + line},
                                      kFocusInk, 0.25f * ImGui::GetFontSize(), 0, line);
  if (scrolls_ > 0) ImGui::SetScrollHereY(0.5f);
  return true;
}

float PanelControls::width_of(const char* label) const {
  return ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
}

void PanelControls::flow(float width) {
  const float right = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width;
  const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (right <= edge + 0.5f) ImGui::SameLine();
}

// Its words may be others in the next picture, and it is the same.
bool PanelControls::draw_button(const char* label, Look look, float width) {
  const LookColours colours = colours_of(look);
  ImGui::PushStyleColor(ImGuiCol_Button, colours.rest);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colours.over);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, colours.pressed);
  const ImVec2 place = ImGui::GetCursorScreenPos();
  const float w = width > 0.0f ? width : width_of(label), h = ImGui::GetFrameHeight();
  const bool is_clicked = ImGui::Button("##b", {w, h});
  const ImVec2 size = ImGui::CalcTextSize(label);
  ImGui::GetWindowDrawList()->AddText({std::round(place.x + std::max(0.0f, 0.5f * (w - size.x))),
                                       std::round(place.y + 0.5f * (h - size.y))},
                                      ImGui::GetColorU32(ImGuiCol_Text), label);
  ImGui::PopStyleColor(3);
  return is_clicked;
}

bool PanelControls::button(const char* id, const char* label, Look look, float width) {
  ImGui::PushID(id);
  const bool is_clicked = draw_button(label, look, width);
  const bool has_focus = settle(ImGui::GetID("##b"));
  ImGui::PopID();
  return is_clicked || (has_focus && is_pressed_);
}

bool PanelControls::mouse_button(const char* id, const char* label, Look look) {
  ImGui::PushID(id);
  const bool is_clicked = draw_button(label, look, 0.0f);
  ImGui::PopID();
  return is_clicked;
}

void PanelControls::take_keyboard() {
  if (has_keyboard_ && !order_.empty()) focus_ = order_.back();
}

bool PanelControls::row(const char* id, float height) {
  ImGui::PushID(id);
  const bool is_clicked =
      ImGui::InvisibleButton("##r", {std::max(1.0f, ImGui::GetContentRegionAvail().x), height});
  if (ImGui::IsItemHovered())
    ImGui::GetWindowDrawList()->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                              IM_COL32(255, 255, 255, 20),
                                              0.25f * ImGui::GetFontSize());
  const bool has_focus = settle(ImGui::GetID("##r"));
  ImGui::PopID();
  return is_clicked || (has_focus && is_pressed_);
}

bool PanelControls::slider(const char* id, float width, float& value, float least, float most,
                           float step, const char* words) {
  ImGui::PushID(id);
  ImGui::SetNextItemWidth(width);
  // Filled up to its value, so that no grip stands in its words.
  for (const ImGuiCol grip : {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive})
    ImGui::PushStyleColor(grip, IM_COL32(0, 0, 0, 0));
  bool is_changed = ImGui::SliderFloat("##s", &value, least, most, "");
  ImGui::PopStyleColor(2);
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float filled = (value - least) / (most - least) * (high.x - low.x);
  if (filled > 1.0f)
    ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + filled, high.y}, kFillInk,
                                              ImGui::GetStyle().FrameRounding);
  const ImVec2 size = ImGui::CalcTextSize(words);
  ImGui::GetWindowDrawList()->AddText(
      {0.5f * (low.x + high.x - size.x), 0.5f * (low.y + high.y - size.y)},
      ImGui::GetColorU32(ImGuiCol_Text), words);
  if (settle(ImGui::GetID("##s")) && steps_ != 0) {
    value = std::clamp(value + step * static_cast<float>(steps_), least, most);
    is_changed = true;
  }
  ImGui::PopID();
  return is_changed;
}

}  // namespace dance
