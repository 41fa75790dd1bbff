#include "lobby/screen/lobby_kit.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "core/base/text/plain_text.h"

namespace dance {
namespace {

const ImVec4 kBackground{0.075f, 0.082f, 0.106f, 1.0f};
const ImVec4 kCard{0.118f, 0.128f, 0.161f, 1.0f};
const ImVec4 kRaised{0.180f, 0.194f, 0.239f, 1.0f};
const ImVec4 kHovered{0.235f, 0.252f, 0.306f, 1.0f};
const ImVec4 kInk{0.945f, 0.940f, 0.920f, 1.0f};
const ImVec4 kDim{0.660f, 0.680f, 0.730f, 1.0f};
const ImVec4 kAccent{1.000f, 0.545f, 0.400f, 1.0f};
const ImVec4 kAccentHovered{1.000f, 0.640f, 0.515f, 1.0f};
const ImVec4 kOnAccent{0.110f, 0.055f, 0.040f, 1.0f};
const ImVec4 kChosen{0.320f, 0.205f, 0.175f, 1.0f};
const ImVec4 kChosenHovered{0.385f, 0.250f, 0.215f, 1.0f};
const ImVec4 kOnChosen{1.000f, 0.700f, 0.590f, 1.0f};
const ImVec4 kTrouble{0.330f, 0.165f, 0.150f, 1.0f};
const ImVec4 kGood{0.120f, 0.235f, 0.190f, 1.0f};
const ImVec4 kClear{0.0f, 0.0f, 0.0f, 0.0f};

constexpr float kButtonHeight_u = 44.0f;
constexpr float kCardPad_u = 18.0f;
constexpr float kLabelColumn_u = 170.0f;

ImU32 u32(const ImVec4& colour) { return ImGui::ColorConvertFloat4ToU32(colour); }

struct Colours {
  ImVec4 rest, hovered, ink;
};
Colours colours_of(ButtonLook look) {
  if (look == ButtonLook::kAccent) return {kAccent, kAccentHovered, kOnAccent};
  if (look == ButtonLook::kChosen) return {kChosen, kChosenHovered, kOnChosen};
  if (look == ButtonLook::kQuiet) return {kClear, kRaised, kDim};
  return {kRaised, kHovered, kInk};
}

void push_colours(const Colours& colours) {
  ImGui::PushStyleColor(ImGuiCol_Button, colours.rest);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colours.hovered);
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, colours.hovered);
  ImGui::PushStyleColor(ImGuiCol_Text, colours.ink);
}

}  // namespace

void LobbyKit::apply_style() const {
  ImGuiStyle style;
  style.WindowPadding = ImVec2(0.0f, 0.0f);
  style.FramePadding = ImVec2(16.0f, 13.0f);
  style.ItemSpacing = ImVec2(10.0f, 10.0f);
  style.ItemInnerSpacing = ImVec2(8.0f, 8.0f);
  style.WindowBorderSize = style.FrameBorderSize = style.ChildBorderSize = 0.0f;
  style.FrameRounding = 9.0f;
  style.ChildRounding = style.PopupRounding = 12.0f;
  style.ScrollbarSize = 12.0f;
  style.ScrollbarRounding = 6.0f;
  style.ScaleAllSizes(scale_);
  auto& colours = style.Colors;
  colours[ImGuiCol_WindowBg] = kBackground;
  colours[ImGuiCol_ChildBg] = kClear;
  colours[ImGuiCol_PopupBg] = kCard;
  colours[ImGuiCol_Text] = kInk;
  colours[ImGuiCol_TextDisabled] = kDim;
  colours[ImGuiCol_FrameBg] = kRaised;
  colours[ImGuiCol_FrameBgHovered] = kHovered;
  colours[ImGuiCol_FrameBgActive] = kHovered;
  colours[ImGuiCol_TextSelectedBg] = ImVec4(kAccent.x, kAccent.y, kAccent.z, 0.45f);
  colours[ImGuiCol_NavHighlight] = kInk;
  colours[ImGuiCol_ScrollbarBg] = kClear;
  colours[ImGuiCol_ScrollbarGrab] = kRaised;
  colours[ImGuiCol_ScrollbarGrabHovered] = kHovered;
  colours[ImGuiCol_ScrollbarGrabActive] = kHovered;
  colours[ImGuiCol_Header] = kRaised;
  colours[ImGuiCol_HeaderHovered] = kHovered;
  colours[ImGuiCol_HeaderActive] = kHovered;
  colours[ImGuiCol_ModalWindowDimBg] = ImVec4(0.02f, 0.02f, 0.03f, 0.72f);
  ImGui::GetStyle() = style;
}

float LobbyKit::room_px() const { return ImGui::GetContentRegionAvail().x; }

void LobbyKit::look_at_text(const char* words, float width_px, float room_px) {
  if (clipped_ != nullptr && width_px > room_px + 0.5f) clipped_->emplace_back(words);
}

void LobbyKit::look_at_item(const char* words) {
  const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  look_at_text(words, ImGui::GetItemRectMax().x, edge);
}

void LobbyKit::title(const char* text) {
  ImGui::PushFont(fonts_.title);
  ImGui::TextUnformatted(text);
  look_at_item(text);
  ImGui::PopFont();
}

void LobbyKit::text(const std::string& text) {
  ImGui::PushTextWrapPos(ImGui::GetWindowContentRegionMax().x - px(kCardPad_u));
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  look_at_item(text.c_str());
}

void LobbyKit::note(const std::string& words) {
  ImGui::PushFont(fonts_.small);
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  text(words);
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void LobbyKit::label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  look_at_text(text, ImGui::GetItemRectSize().x, px(kLabelColumn_u - 8.0f));
  ImGui::SameLine(px(kCardPad_u + kLabelColumn_u));
}

void LobbyKit::gap(float u) { ImGui::Dummy(ImVec2(0.0f, px(u))); }

// Drawn behind what is in it when its end is known.
void LobbyKit::begin_card(const char* title) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->ChannelsSplit(2);
  list->ChannelsSetCurrent(1);
  ImGui::BeginGroup();
  ImGui::Dummy(ImVec2(0.0f, px(kCardPad_u - 10.0f)));
  ImGui::Indent(px(kCardPad_u));
  if (title == nullptr) return;
  text(title);
  ImGui::Dummy(ImVec2(0.0f, px(2.0f)));
}

void LobbyKit::end_card() {
  ImGui::Unindent(px(kCardPad_u));
  ImGui::Dummy(ImVec2(0.0f, px(kCardPad_u - 10.0f)));
  ImGui::EndGroup();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->ChannelsSetCurrent(0);
  const ImVec2 low = ImGui::GetItemRectMin();
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  list->AddRectFilled(low, {right, ImGui::GetItemRectMax().y}, u32(kCard), px(14.0f));
  list->ChannelsMerge();
  gap(4.0f);
}

bool LobbyKit::button(const char* words, ButtonLook look, float least_u) {
  push_colours(colours_of(look));
  const float width = ImGui::CalcTextSize(words, nullptr, true).x + px(36.0f);
  const bool is_pressed =
      ImGui::Button(words, ImVec2(std::max(width, px(least_u)), px(kButtonHeight_u)));
  ImGui::PopStyleColor(4);
  look_at_item(words);
  return is_pressed;
}

bool LobbyKit::choice(const char* words, bool is_chosen) {
  return button(words, is_chosen ? ButtonLook::kChosen : ButtonLook::kPlain);
}

bool LobbyKit::small_button(const char* words) {
  ImGui::PushFont(fonts_.small);
  push_colours(colours_of(ButtonLook::kQuiet));
  const ImVec2 size(ImGui::CalcTextSize(words, nullptr, true).x + px(20.0f), px(32.0f));
  const bool is_pressed = ImGui::Button(words, size);
  ImGui::PopStyleColor(4);
  ImGui::PopFont();
  look_at_item(words);
  return is_pressed;
}

void LobbyKit::beside(const char* next_words, float least_u) {
  const float width =
      std::max(px(least_u), ImGui::CalcTextSize(next_words, nullptr, true).x + px(36.0f));
  const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float next = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x;
  if (next + width <= edge - px(kCardPad_u)) ImGui::SameLine();
}

std::string LobbyKit::shortened(const std::string& full_text, float width_px) {
  const std::string text = plain_text(full_text);
  if (ImGui::CalcTextSize(text.c_str()).x <= width_px) return text;
  const auto is_middle_of_character = [&](std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u;
  };
  for (std::size_t left_out = 1; left_out < text.size(); ++left_out) {
    std::size_t begin = (text.size() - left_out) / 2;
    std::size_t end = begin + left_out;
    while (begin > 0 && is_middle_of_character(begin)) --begin;
    while (is_middle_of_character(end)) ++end;
    std::string short_text = text.substr(0, begin) + "\u2026" + text.substr(end);
    if (ImGui::CalcTextSize(short_text.c_str()).x <= width_px) return short_text;
  }
  return "\u2026";
}

bool LobbyKit::row(const char* id, const std::string& what, const std::string& more, bool is_chosen,
                   float right_room_u) {
  const float width = room_px() - px(kCardPad_u) - px(right_room_u);
  const float height = px(more.empty() ? kButtonHeight_u : 58.0f);
  push_colours({is_chosen ? kHovered : kRaised, kHovered, kInk});
  ImGui::PushID(id);
  const bool is_pressed = ImGui::Button("##row", ImVec2(width, height));
  ImGui::PopID();
  ImGui::PopStyleColor(4);
  look_at_item(what.c_str());
  const ImVec2 low = ImGui::GetItemRectMin();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (is_chosen)
    list->AddRectFilled(low, {low.x + px(5.0f), low.y + height}, u32(kAccent), px(3.0f));
  const float x = low.x + px(16.0f);
  const float room = width - px(32.0f);
  const float body = fonts_.body->FontSize, small = fonts_.small->FontSize;
  const float block = more.empty() ? body : body + small + px(4.0f);
  float y = low.y + 0.5f * (height - block);
  list->AddText(fonts_.body, body, {std::round(x), std::round(y)}, u32(kInk),
                shortened(what, room).c_str());
  if (more.empty()) return is_pressed;
  y += body + px(4.0f);
  ImGui::PushFont(fonts_.small);
  const std::string line = shortened(more, room);
  ImGui::PopFont();
  list->AddText(fonts_.small, small, {std::round(x), std::round(y)}, u32(kDim), line.c_str());
  return is_pressed;
}

bool LobbyKit::tile(const char* heading, const char* what, float width_px, ButtonLook look) {
  const Colours colours = colours_of(look);
  const float pad = px(20.0f);
  const float wrap = width_px - 2.0f * pad;
  const float small = fonts_.small->FontSize, title = fonts_.title->FontSize;
  const ImVec2 words = fonts_.small->CalcTextSizeA(small, 1e5f, wrap, what);
  const float height = std::max(px(112.0f), 2.0f * pad + title + px(8.0f) + words.y);
  push_colours(colours);
  ImGui::PushID(heading);
  const bool is_pressed = ImGui::Button("##tile", ImVec2(width_px, height));
  ImGui::PopID();
  ImGui::PopStyleColor(4);
  look_at_item(heading);
  look_at_text(heading, fonts_.title->CalcTextSizeA(title, 1e5f, 0.0f, heading).x, wrap);
  const ImVec2 low = ImGui::GetItemRectMin();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddText(fonts_.title, title, {low.x + pad, low.y + pad}, u32(colours.ink), heading);
  const ImVec4 soft(colours.ink.x, colours.ink.y, colours.ink.z, 0.82f);
  list->AddText(fonts_.small, small, {low.x + pad, low.y + pad + title + px(8.0f)}, u32(soft), what,
                nullptr, wrap);
  return is_pressed;
}

bool LobbyKit::field(const char* id, std::string& value, float width_u, std::size_t most_bytes) {
  std::string buffer = value;
  buffer.resize(most_bytes + 1, '\0');
  ImGui::SetNextItemWidth(std::min(px(width_u), room_px() - px(kCardPad_u)));
  // A click selects all of it, so that what is typed next takes its place.
  const bool has_changed =
      ImGui::InputText(id, buffer.data(), buffer.size(), ImGuiInputTextFlags_AutoSelectAll);
  look_at_item(id);
  if (has_changed) value = buffer.c_str();
  return has_changed;
}

void LobbyKit::box(const std::string& words) {
  const float pad = px(12.0f);
  const float width = room_px() - px(kCardPad_u);
  ImGui::PushFont(fonts_.small);
  const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, width - 2.0f * pad);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, {low.x + width, low.y + size.y + 2.0f * pad}, u32(kBackground),
                      px(8.0f));
  list->AddText(fonts_.small, fonts_.small->FontSize, {low.x + pad, low.y + pad}, u32(kInk),
                words.c_str(), nullptr, width - 2.0f * pad);
  ImGui::PopFont();
  ImGui::Dummy(ImVec2(width, size.y + 2.0f * pad));
  look_at_item(words.c_str());
}

void LobbyKit::meter(float level, float held) {
  const float width = std::min(room_px() - px(kCardPad_u), px(420.0f)), height = px(14.0f);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, {low.x + width, low.y + height}, u32(kBackground), px(7.0f));
  const float end = low.x + std::clamp(level, 0.0f, 1.0f) * width;
  list->AddRectFilled(low, {end, low.y + height}, u32(kAccent), px(7.0f));
  const float mark = low.x + std::clamp(held, 0.0f, 1.0f) * (width - px(3.0f));
  list->AddRectFilled({mark, low.y}, {mark + px(3.0f), low.y + height}, u32(kInk));
  ImGui::Dummy(ImVec2(width, height));
}

void LobbyKit::code(int size, const std::vector<bool>& dark) {
  const float module = std::max(2.0f, std::floor(px(3.0f)));
  const float quiet = 4.0f * module;
  const float side = module * static_cast<float>(size) + 2.0f * quiet;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, {low.x + side, low.y + side}, IM_COL32_WHITE);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto at = static_cast<std::size_t>(y * size + x);
      if (at >= dark.size() || !dark[at]) continue;
      const ImVec2 from(low.x + quiet + module * static_cast<float>(x),
                        low.y + quiet + module * static_cast<float>(y));
      list->AddRectFilled(from, {from.x + module, from.y + module}, IM_COL32_BLACK);
    }
  ImGui::Dummy(ImVec2(side, side));
}

LobbyKit::Strip LobbyKit::strip(int id, bool is_trouble, const std::string& words,
                                const std::string& detail, const char* button_words,
                                const char* other_words) {
  Strip pressed = Strip::kNone;
  ImGui::PushID(id);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->ChannelsSplit(2);
  list->ChannelsSetCurrent(1);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float close = px(44.0f);
  const auto room_of = [&](const char* it) {
    return it != nullptr ? ImGui::CalcTextSize(it).x + px(46.0f) : 0.0f;
  };
  const float other_room = room_of(other_words);
  const float button_room = room_of(button_words) + other_room;
  const float wrap = right - close - button_room - px(16.0f) - ImGui::GetWindowPos().x;
  ImGui::BeginGroup();
  gap(2.0f);
  ImGui::Indent(px(kCardPad_u));
  ImGui::PushTextWrapPos(wrap);
  ImGui::TextUnformatted(words.c_str());
  look_at_text(words.c_str(), ImGui::GetItemRectMax().x, right - close - button_room);
  if (!detail.empty()) {
    ImGui::PushFont(fonts_.small);
    ImGui::PushStyleColor(ImGuiCol_Text, kDim);
    ImGui::TextUnformatted(detail.c_str());
    ImGui::PopStyleColor();
    ImGui::PopFont();
  }
  ImGui::PopTextWrapPos();
  ImGui::Unindent(px(kCardPad_u));
  gap(2.0f);
  ImGui::EndGroup();
  const float bottom = std::max(ImGui::GetItemRectMax().y, low.y + px(kButtonHeight_u + 8.0f));
  const float y = 0.5f * (low.y + bottom - px(kButtonHeight_u));
  if (button_words != nullptr) {
    ImGui::SetCursorScreenPos({right - close - button_room, y});
    if (button(button_words)) pressed = Strip::kButton;
  }
  if (other_words != nullptr) {
    ImGui::SetCursorScreenPos({right - close - other_room, y});
    if (button(other_words)) pressed = Strip::kOtherButton;
  }
  ImGui::SetCursorScreenPos({right - close - px(4.0f), y});
  push_colours(colours_of(ButtonLook::kQuiet));
  if (ImGui::Button("x", ImVec2(close, px(kButtonHeight_u)))) pressed = Strip::kClose;
  ImGui::PopStyleColor(4);
  list->ChannelsSetCurrent(0);
  list->AddRectFilled(low, {right, bottom}, u32(is_trouble ? kTrouble : kGood), px(12.0f));
  list->ChannelsMerge();
  ImGui::SetCursorScreenPos({low.x, bottom + px(8.0f)});
  ImGui::PopID();
  return pressed;
}

}  // namespace dance
