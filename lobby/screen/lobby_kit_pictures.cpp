// The widgets of LobbyKit for pictures and colours.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "lobby/screen/lobby_kit.h"

namespace dance {
namespace {

constexpr float kRounding_u = 10.0f;
constexpr float kSwatch_u = 26.0f, kSwatchGap_u = 6.0f, kSwatchRow_u = 44.0f;
constexpr ImU32 kNoPicture = IM_COL32(46, 49, 61, 255);
constexpr ImU32 kPictureText = IM_COL32(241, 240, 235, 255),
                kPictureAccent = IM_COL32(255, 139, 102, 255);
// The page's background (kBackground in lobby_kit.cpp), opaque and clear.
constexpr ImU32 kPageColour = IM_COL32(19, 21, 27, 255), kPageClear = IM_COL32(19, 21, 27, 0);
// The dance behind the page is darker than the buttons.
constexpr ImU32 kDimmed = IM_COL32(200, 200, 206, 255);
constexpr float kFades_u = 110.0f;

// Rows of a framebuffer's texture begin at the bottom.
void add_picture(ImDrawList& list, void* texture, const ImVec2& low, const ImVec2& high,
                 float rounding) {
  if (texture == nullptr)
    list.AddRectFilled(low, high, kNoPicture, rounding);
  else
    list.AddImageRounded(texture, low, high, {0.0f, 1.0f}, {1.0f, 0.0f}, IM_COL32_WHITE, rounding);
}

}  // namespace

void LobbyKit::picture(void* texture, float width_px, float height_px) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  add_picture(*ImGui::GetWindowDrawList(), texture, low, {low.x + width_px, low.y + height_px},
              px(kRounding_u));
  ImGui::Dummy({width_px, height_px});
}

bool LobbyKit::picture_choice(const char* id, void* texture, const std::string& words,
                              float width_u, float height_u, bool is_chosen) {
  const float width = px(width_u), height = px(height_u), small = fonts_.small->FontSize;
  ImGui::PushID(id);
  const bool is_pressed = ImGui::InvisibleButton("##picture", {width, height + small + px(8.0f)});
  const bool is_lit = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  ImGui::PopID();
  const ImVec2 low = ImGui::GetItemRectMin(), high(low.x + width, low.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  add_picture(*list, texture, low, high, px(kRounding_u));
  if (is_chosen || is_lit)
    list->AddRect(low, high, is_chosen ? kPictureAccent : kPictureText, px(kRounding_u), 0,
                  px(3.0f));
  ImGui::PushFont(fonts_.small);
  const std::string shown = shortened(words, width);
  const float left = low.x + 0.5f * (width - ImGui::CalcTextSize(shown.c_str()).x);
  ImGui::PopFont();
  list->AddText(fonts_.small, small, {std::round(left), std::round(high.y + px(5.0f))},
                is_chosen ? kPictureAccent : kPictureText, shown.c_str());
  return is_pressed;
}

bool LobbyKit::swatch(const char* id, std::uint32_t rgb, bool is_chosen) {
  const float side = px(kSwatch_u);
  ImGui::PushID(id);
  // The same height as the label before it.
  const bool is_pressed = ImGui::InvisibleButton("##colour", {side, px(kSwatchRow_u)});
  const bool is_lit = ImGui::IsItemHovered() || ImGui::IsItemFocused();
  ImGui::PopID();
  const float top = ImGui::GetItemRectMin().y + 0.5f * px(kSwatchRow_u - kSwatch_u);
  const ImVec2 low(ImGui::GetItemRectMin().x, top), high(low.x + side, top + side);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, high, IM_COL32(rgb >> 16 & 0xff, rgb >> 8 & 0xff, rgb & 0xff, 255),
                      px(6.0f));
  if (is_chosen || is_lit)
    list->AddRect({low.x - px(3.0f), low.y - px(3.0f)}, {high.x + px(3.0f), high.y + px(3.0f)},
                  is_chosen ? kPictureAccent : kPictureText, px(8.0f), 0, px(2.0f));
  const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (high.x + px(2.0f * kSwatchGap_u) + side < edge) ImGui::SameLine(0.0f, px(kSwatchGap_u));
  return is_pressed;
}

void LobbyKit::backdrop(void* texture, float aspect, float width_px, float height_px) {
  if (texture == nullptr) return;
  const float cut = 0.5f * std::max(0.0f, 1.0f - width_px / (aspect * height_px));
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const ImVec2 low(right - width_px, ImGui::GetCursorScreenPos().y);
  const ImVec2 high(right, low.y + height_px);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddImage(texture, low, high, {cut, 1.0f}, {1.0f - cut, 0.0f}, kDimmed);
  const float fade = std::min(px(kFades_u), 0.5f * width_px);
  list->AddRectFilledMultiColor(low, {low.x + fade, high.y}, kPageColour, kPageClear, kPageClear,
                                kPageColour);
  const float foot = 0.25f * height_px;
  list->AddRectFilledMultiColor({low.x, high.y - foot}, high, kPageClear, kPageClear, kPageColour,
                                kPageColour);
}

}  // namespace dance
