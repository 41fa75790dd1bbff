// What the dance panel draws over the picture, whether it is open or not: the corner's button, the
// banner, the count.
#include <algorithm>
#include <cmath>

#include "viewer/dance_panel/dance_panel.h"
#include "viewer/dance_panel/panel_style.h"
#include "viewer/words/shown_name.h"

namespace dance {
namespace {

constexpr float kBanner_em = 34.0f;
constexpr float kLeastBanner_em = 26.0f;
constexpr Duration kCornerHolds = Duration::s(3);
constexpr std::size_t kMostNamed = 3;

// "bob, carla", or "bob, carla, dora +4".
std::string listed(const std::vector<std::string_view>& names) {
  std::string all;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNamed); ++i)
    all += (i > 0 ? ", " : "") + std::string(names[i]);
  if (names.size() > kMostNamed) all += " +" + std::to_string(names.size() - kMostNamed);
  return all;
}

}  // namespace

// The way in for the mouse, and the mark of a recording.
void DancePanel::draw_corner(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  const float em = frame.small_font->FontSize, margin = 0.7f * em, size = 2.2f * em;
  const float x = is_at_left() ? margin : frame.width_px - margin - size;
  if (recording_.state() != DanceRecording::State::kIdle) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const std::string time = panel_style::clock_text(recording_.elapsed(now));
    const float width = ImGui::CalcTextSize(time.c_str()).x + 1.9f * em;
    const float left = is_at_left() ? x + size + 0.4f * em : x - 0.4f * em - width;
    const float middle = margin + 0.5f * size;
    list.AddRectFilled({left, middle - 0.8f * em}, {left + width, middle + 0.8f * em},
                       panel_style::kBackground, 0.8f * em);
    list.AddCircleFilled({left + 0.8f * em, middle}, 0.36f * em, panel_style::kBad, 20);
    list.AddText({std::round(left + 1.4f * em), std::round(middle - 0.5f * em)}, panel_style::kText,
                 time.c_str());
  }
  if (!mouse_moved_.is_set() || now - mouse_moved_ > kCornerHolds) return;
  ImGui::SetNextWindowPos({x, margin});
  ImGui::SetNextWindowSize({size, size});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  if (ImGui::Begin("dance-corner", nullptr, panel_style::kWindow)) {
    const bool is_clicked = ImGui::InvisibleButton("open", {size, size});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(
        {x, margin}, {x + size, margin + size},
        ImGui::IsItemHovered() ? IM_COL32(52, 60, 78, 240) : panel_style::kBackground, 0.4f * em);
    for (int i = -1; i <= 1; ++i) {
      const float y = std::round(margin + 0.5f * size + 0.5f * em * static_cast<float>(i));
      list.AddLine({x + 0.55f * em, y}, {x + size - 0.55f * em, y}, panel_style::kText,
                   std::max(1.0f, std::round(0.14f * em)));
    }
    if (is_clicked) open(true);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void DancePanel::act(BannerAction action) {
  if (action == BannerAction::kLeave) needs_.wishes.leaves = true;
  if (action == BannerAction::kUnmute) ++needs_.wishes.mute_presses;
}

// At the top, in the middle of what the column leaves; two lines and a button.
float DancePanel::draw_banner(const PanelFrame& frame) {
  const auto kind = banners_.choose(watch_.facts());
  if (!kind) return 0.0f;
  const Banner banner = banner_of(*kind, watch_.facts(), texts_);
  const float em = frame.small_font->FontSize, margin = 0.7f * em;
  const float column = is_open_ ? panel_style::column_width(em, frame.width_px) : 0.0f;
  float left = is_at_left() ? column : 0.0f;
  const float right = frame.width_px - (is_at_left() ? 0.0f : column);
  // Beside the figures, where that leaves enough.
  if (right - frame.figures_px > kLeastBanner_em * em) left = std::max(left, frame.figures_px);
  const float width = std::min(kBanner_em * em, right - left - 4.0f * margin);
  const float middle = 0.5f * (left + right);
  ImGui::SetNextWindowPos({std::round(middle - 0.5f * width), margin});
  ImGui::SetNextWindowSize({width, banner_px_ > 0.0f ? banner_px_ : 6.0f * em});
  if (ImGui::Begin("dance-banner", nullptr, panel_style::kWindow)) {
    panel_style::PanelBackground background(width);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImU32 ink = banner.is_grave ? panel_style::kBad : panel_style::kFair;
    panel_style::draw_quality(*ImGui::GetWindowDrawList(),
                              banner.is_grave ? QualityLevel::kBad : QualityLevel::kFair,
                              {low.x + 0.4f * em, low.y + 0.55f * em}, 0.38f * em);
    const float close = controls_.width_of("x");
    ImGui::Indent(1.4f * em);
    ImGui::PushTextWrapPos(width - 1.5f * em - close);
    ImGui::PushStyleColor(ImGuiCol_Text, ink);
    ImGui::TextUnformatted(banner.what.c_str());
    ImGui::PopStyleColor();
    ImGui::TextUnformatted(banner.cure.c_str());
    ImGui::PopTextWrapPos();
    const Text label = banner.action == BannerAction::kLeave ? Text::kLeave : Text::kDanceUnmuteMe;
    if (banner.action != BannerAction::kNone &&
        controls_.button("act", texts_[label], PanelControls::Look::kStrong))
      act(banner.action);
    banner_px_ = ImGui::GetCursorPosY() + 0.4f * em;
    ImGui::SetCursorPos({width - close - 0.5f * em, 0.45f * em});
    if (controls_.button("close", "x", PanelControls::Look::kQuiet)) {
      banners_.close(*kind);
      if (*kind == BannerKind::kRecordingFailed) recording_.forget_trouble();
    }
    background.end(banner_px_, panel_style::kBackground, 0.5f * em);
  }
  ImGui::End();
  return margin + banner_px_;
}

// Shown in the middle below the banner while another house records.
float DancePanel::draw_recorders(const PanelFrame& frame, float banner_end_px) const {
  if (frame.scene.recorders.empty()) return banner_end_px;
  std::vector<std::string_view> names;
  for (const GuestId& guest : frame.scene.recorders)
    names.push_back(shown_name(names_, guest, texts_));
  const std::string words = texts_.say(Text::kDanceRecordedBy, {listed(names)});
  ImFont* const font = frame.small_font;
  const float em = font->FontSize, y = banner_end_px + 0.7f * em;
  const float width = font->CalcTextSizeA(em, 1e5f, 0.0f, words.c_str()).x + 1.2f * em;
  const float x = std::round(0.5f * (frame.width_px - width));
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled({x - 0.7f * em, y}, {x + width + 0.7f * em, y + 1.6f * em},
                     panel_style::kBackground, 0.8f * em);
  list.AddCircleFilled({x + 0.4f * em, y + 0.8f * em}, 0.36f * em, panel_style::kBad, 20);
  list.AddText(font, em, {x + 1.2f * em, std::round(y + 0.3f * em)}, panel_style::kText,
               words.c_str());
  return y + 1.6f * em;
}

// Shown in the middle below the banner and the recorders.
void DancePanel::draw_arrivals(const PanelFrame& frame, float banner_end_px) const {
  ImFont* const font = frame.large_font;
  const float size = font->FontSize, margin = 0.7f * frame.small_font->FontSize;
  float y = banner_end_px + margin;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Arrivals::Message& message : arrivals_.messages()) {
    const std::string words = texts_.say(message.has_joined ? Text::kDanceJoined : Text::kDanceLeft,
                                         {shown_name(names_, message.guest, texts_)});
    const float width = font->CalcTextSizeA(size, 1e5f, 0.0f, words.c_str()).x;
    const float x = std::round(0.5f * (frame.width_px - width));
    list.AddRectFilled({x - 0.8f * size, y}, {x + width + 0.8f * size, y + 1.7f * size},
                       panel_style::kBackground, 0.85f * size);
    list.AddText(font, size, {x, std::round(y + 0.33f * size)},
                 message.has_joined ? panel_style::kGood : panel_style::kText, words.c_str());
    y += 2.0f * size;
  }
}

void DancePanel::answer_closing(bool closes) {
  needs_.wishes.closing = closes ? Closing::kYes : Closing::kNo;
}

// Without other guests the room closes without a question.
void DancePanel::draw_closing(const PanelFrame& frame) {
  if (needs_.wishes.closing != Closing::kAsked) return;
  std::vector<std::string_view> names;
  for (const DanceGuest& guest : records_.guests())
    if (guest.is_remote) names.push_back(shown_name(names_, guest.id, texts_));
  if (names.empty()) return answer_closing(true);
  const float em = frame.large_font->FontSize;
  const float width = std::min(26.0f * em, frame.width_px - em);
  const std::string words = texts_.say(Text::kDanceClosing, {listed(names)});
  ImGui::PushFont(frame.large_font);
  const float height =
      panel_style::wrapped_height(words, width - 2.0f * em) + ImGui::GetFrameHeight() + 3.0f * em;
  ImGui::SetNextWindowPos(
      {std::round(0.5f * (frame.width_px - width)), std::round(0.4f * (frame.height_px - height))});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em, em});
  if (ImGui::Begin("dance-closing", nullptr, panel_style::kWindow)) {
    panel_style::PanelBackground background(width);
    panel_style::text(panel_style::kText, words.c_str());
    ImGui::SetCursorPosY(height - ImGui::GetFrameHeight() - em);
    if (controls_.mouse_button("close-room", texts_[Text::kDanceCloseRoom],
                               PanelControls::Look::kWarning))
      answer_closing(true);
    ImGui::SameLine();
    if (controls_.mouse_button("stay", texts_[Text::kDanceStay], PanelControls::Look::kStrong))
      answer_closing(false);
    background.end(height, panel_style::kBackground, 0.5f * em);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopFont();
}

// One line at the bottom, far from names and faces.
void DancePanel::draw_slow_note(const PanelFrame& frame) {
  const BannerFacts& facts = watch_.facts();
  if (!slow_note_.is_shown(facts.slow_for, needs_.wishes.knows_slow_drawing, frame.scene.time))
    return;
  const std::string hz = std::to_string(std::lround(facts.pictures_hz));
  const std::string words =
      texts_.say(facts.draws_plainly ? Text::kDanceSlowPlain : Text::kDanceSlow, {hz});
  const float em = frame.small_font->FontSize, gap = 0.6f * em;
  const float close = controls_.width_of("x");
  const float act =
      facts.draws_plainly ? 0.0f : controls_.width_of(texts_[Text::kDanceDrawPlainly]) + gap;
  const float width = std::min(ImGui::CalcTextSize(words.c_str()).x + act + close + 3.0f * gap,
                               frame.width_px - 2.0f * gap);
  const float height = ImGui::GetFrameHeight() + gap;
  ImGui::SetNextWindowPos(
      {std::round(0.5f * (frame.width_px - width)), std::round(frame.height_px - height - gap)});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {gap, 0.5f * gap});
  if (ImGui::Begin("dance-slow", nullptr, panel_style::kWindow)) {
    panel_style::PanelBackground background(width);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(panel_style::fitted(words, width - act - close - 3.0f * gap).c_str());
    if (!facts.draws_plainly) {
      ImGui::SameLine(width - close - act - gap);
      if (controls_.button("plainly", texts_[Text::kDanceDrawPlainly]))
        needs_.wishes.draws_plainly = true;
    }
    ImGui::SameLine(width - close - gap);
    if (controls_.mouse_button("close-slow", "x", PanelControls::Look::kQuiet)) slow_note_.close();
    background.end(height, panel_style::kBackground, 0.5f * em);
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

// As large as it can be seen while dancing, above the dancers.
void DancePanel::draw_count(const PanelFrame& frame) const {
  if (!count_) return;
  ImFont* const font = frame.digit_font != nullptr ? frame.digit_font : frame.large_font;
  const std::string number = std::to_string(count_->number);
  const float size = font->FontSize;
  const ImVec2 extent = font->CalcTextSizeA(size, 1e5f, 0.0f, number.c_str());
  const float alpha = 1.0f - 0.55f * count_->since;
  const ImVec2 at{std::round(0.5f * (frame.width_px - extent.x)),
                  std::round(0.13f * frame.height_px)};
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const auto ink = [&](int r, int g, int b, float share) {
    return IM_COL32(r, g, b, static_cast<int>(255.0f * share));
  };
  list.AddText(font, size, {at.x + 0.03f * size, at.y + 0.03f * size}, ink(0, 0, 0, 0.6f * alpha),
               number.c_str());
  list.AddText(font, size, at,
               count_->is_one ? ink(95, 211, 141, alpha) : ink(255, 255, 255, alpha),
               number.c_str());
}

}  // namespace dance
