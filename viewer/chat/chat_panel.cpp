#include "viewer/chat/chat_panel.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/body/guest_look.h"
#include "viewer/words/shown_name.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 3> kChatKeys{
    {{"", Text::kDoWrite, Text::kKeyEnter}, {"A", Text::kDoApplaud}, {"L", Text::kDoHeart}}};
constexpr ImU32 kPaper = IM_COL32(10, 12, 18, 184);
constexpr ImU32 kField = IM_COL32(26, 31, 43, 240);
constexpr ImU32 kSelected = IM_COL32(61, 111, 181, 200);
constexpr float kWidest_em = 34.0f;
constexpr float kWidestShare = 0.55f;  // of the picture
constexpr Duration kFade = Duration::s(1);
constexpr std::size_t kCountsFrom = kMaxChatCharacters - 40;

ImU32 white(float alpha) { return IM_COL32(244, 245, 249, static_cast<int>(255.0f * alpha)); }

ImU32 faded(ImU32 colour, float alpha) {
  const auto share = static_cast<float>(colour >> IM_COL32_A_SHIFT & 0xffu);
  const auto shown = static_cast<ImU32>(std::lround(share * alpha));
  return (colour & ~IM_COL32_A_MASK) | shown << IM_COL32_A_SHIFT;
}

ImU32 name_colour(const GuestId& guest, float alpha) {
  const Eigen::Vector3f colour = srgb_from_linear(look_of(guest).tag);
  return ImGui::ColorConvertFloat4ToU32(ImVec4(colour.x(), colour.y(), colour.z(), alpha));
}

float width_of(const PanelFrame& frame) {
  return std::min(kWidest_em * frame.large_font->FontSize, kWidestShare * frame.width_px);
}

float text_width(ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, text.c_str()).x;
}

}  // namespace

Text ChatPanel::title() const { return needs_.send ? Text::kKeysChat : Text::kCount; }

std::span<const KeyHelp> ChatPanel::keys() const {
  return needs_.send ? std::span<const KeyHelp>(kChatKeys) : std::span<const KeyHelp>();
}

bool ChatPanel::on_key(const KeyPress& press) {
  if (!needs_.send) return false;
  if (is_open_) return on_field_key(press);
  if (press.is_repeat || press.has_control) return false;
  switch (press.key) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      is_open_ = true;
      return true;
    case GLFW_KEY_A:
      return send_sign(ChatKind::kApplause);
    case GLFW_KEY_L:
      return send_sign(ChatKind::kHeart);
    default:
      return false;
  }
}

// Handles all keys: while the field is open, the window's other keys are off.
bool ChatPanel::on_field_key(const KeyPress& press) {
  const bool is_enter = press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER;
  if (press.key == GLFW_KEY_ESCAPE) {
    is_open_ = false;
    sends_ = false;  // a line that waits for its turn stays in the field
  } else if (is_enter && !press.is_repeat) {
    const std::string line = editor_.text();
    is_open_ = is_chat_line(line);
    sends_ = is_open_;
    if (!is_open_) editor_.clear();
    send_line();
  } else if (editor_.on_key(press)) {
    sends_ = false;
  } else if (press.has_control && press.key == GLFW_KEY_V) {
    if (const char* text = ImGui::GetClipboardText()) editor_.insert(std::string_view(text));
    sends_ = false;
  } else if (press.has_control && (press.key == GLFW_KEY_C || press.key == GLFW_KEY_X)) {
    if (!editor_.selection().empty()) ImGui::SetClipboardText(editor_.selection().c_str());
    if (press.key == GLFW_KEY_X) editor_.erase_selection();
  }
  return true;
}

bool ChatPanel::on_character(char32_t character) {
  if (!is_open_) return false;
  sends_ = false;
  editor_.insert(character);
  return true;
}

void ChatPanel::send_line() {
  const auto writer = needs_.writer();
  if (!sends_ || !writer || (line_sent_.is_set() && now_ - line_sent_ < kChatPeriod)) return;
  needs_.send(*writer, ChatKind::kLine, editor_.text());
  line_sent_ = now_;
  sends_ = false;
  editor_.clear();
}

bool ChatPanel::send_sign(ChatKind kind) {
  const auto writer = needs_.writer();
  if (!writer || (sign_sent_.is_set() && now_ - sign_sent_ < kChatPeriod)) return true;
  needs_.send(*writer, kind, "");
  sign_sent_ = now_;
  return true;
}

void ChatPanel::draw(const PanelFrame& frame) {
  if (frame.large_font == nullptr) return;
  now_ = frame.scene.time;
  if (sends_) send_line();
  const float notes =
      1.35f * frame.small_font->FontSize * static_cast<float>(frame.scene.notes.size() + 1);
  const float bottom =
      frame.height_px - notes - (needs_.bottom_px ? needs_.bottom_px(frame) : 0.0f);
  draw_lines(frame, is_open_ ? draw_field(frame, bottom) : bottom);
}

float ChatPanel::draw_field(const PanelFrame& frame, float bottom_px) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  ImFont* const small = frame.small_font;
  const float em = frame.large_font->FontSize, pad = 0.5f * em, width = width_of(frame);
  const bool is_mute = !needs_.writer();
  const float hint_y = std::round(bottom_px - 1.3f * small->FontSize);
  const float top = std::round(hint_y - em - 2.4f * pad);
  list.AddRectFilled({pad, top}, {pad + width, bottom_px}, kField, 0.4f * em);
  draw_text(list, frame, 2.0f * pad, std::round(top + pad), width - 2.0f * pad);
  std::string hint = texts_[is_mute ? Text::kChatNobody : Text::kChatHint];
  if (editor_.size() >= kCountsFrom)
    hint = std::to_string(editor_.size()) + " / " + std::to_string(kMaxChatCharacters);
  list.AddText(small, small->FontSize, {2.0f * pad, hint_y}, white(0.6f), hint.c_str());
  return top - 0.5f * pad;
}

// Scrolls a long line, so that the caret stays visible.
void ChatPanel::draw_text(ImDrawList& list, const PanelFrame& frame, float x, float y,
                          float width) const {
  ImFont* const font = frame.large_font;
  const float em = font->FontSize;
  const float caret = text_width(font, editor_.before_caret());
  const float left = std::round(x - std::max(0.0f, caret - width + 0.3f * em));
  list.PushClipRect({x, y - 0.2f * em}, {x + width, y + 1.3f * em}, true);
  const float marked = left + text_width(font, editor_.before_selection());
  if (const std::string selection = editor_.selection(); !selection.empty())
    list.AddRectFilled({marked, y}, {marked + text_width(font, selection), y + 1.1f * em},
                       kSelected);
  list.AddText(font, em, {left, y}, white(1.0f), editor_.text().c_str());
  list.AddRectFilled({left + caret, y}, {left + caret + std::max(1.0f, 0.08f * em), y + 1.1f * em},
                     white(0.9f));
  list.PopClipRect();
}

void ChatPanel::draw_lines(const PanelFrame& frame, float bottom_px) const {
  ImDrawList& list = *(is_open_ ? ImGui::GetForegroundDrawList() : ImGui::GetBackgroundDrawList());
  ImFont* const font = frame.large_font;
  const float em = font->FontSize, pad = 0.5f * em;
  const float wrap = width_of(frame) - 2.0f * pad;
  const float top = (is_open_ ? 0.1f : 0.4f) * frame.height_px;
  const auto& lines = frame.scene.lines;
  std::size_t shown = 0;
  float y = bottom_px;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const Duration age = now_ - line->written;
    if (!is_open_ && (age >= kFresh || shown == kMostFresh)) break;
    if (needs_.is_hidden && needs_.is_hidden(line->guest)) continue;
    const std::string name = std::string(shown_name(frame.scene.names, line->guest, texts_)) + ":";
    const std::string words = name + " " + line->text;
    const float height = font->CalcTextSizeA(em, 1e6f, wrap, words.c_str()).y;
    y -= height + pad;
    if (y < top) break;
    const auto left_s = static_cast<float>((kFresh - age).as_seconds() / kFade.as_seconds());
    const float alpha = is_open_ ? 1.0f : std::clamp(left_s, 0.0f, 1.0f);
    const float width = std::min(wrap, text_width(font, words));
    const ImVec2 at{2.0f * pad, std::round(y)};
    list.AddRectFilled({pad, at.y - 0.2f * pad}, {3.0f * pad + width, at.y + height + 0.3f * pad},
                       faded(kPaper, alpha), 0.4f * em);
    list.AddText(font, em, at, white(alpha), words.c_str(), nullptr, wrap);
    list.AddText(font, em, at, name_colour(line->guest, alpha), name.c_str(), nullptr, wrap);
    ++shown;
  }
}

}  // namespace dance
