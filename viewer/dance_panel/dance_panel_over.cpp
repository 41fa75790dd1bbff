// What the dance panel draws over the picture, whether it is open or not: the corner's button, the
// banner, the count.
#include <algorithm>
#include <cmath>

#include "viewer/dance_panel/dance_ink.h"
#include "viewer/dance_panel/dance_panel.h"

namespace dance {
namespace {

constexpr float kBanner_em = 34.0f;
constexpr float kLeastBanner_em = 26.0f;
constexpr Duration kCornerHolds = Duration::s(3);

}  // namespace

// The way in for the mouse, and the mark of a recording.
void DancePanel::draw_corner(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  const float em = frame.small_font->FontSize, margin = 0.7f * em, size = 2.2f * em;
  const float x = is_at_left() ? margin : frame.width_px - margin - size;
  if (recording_.state() != DanceRecording::State::kIdle) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const std::string time = dance_ink::clock_text(recording_.elapsed(now));
    const float width = ImGui::CalcTextSize(time.c_str()).x + 1.9f * em;
    const float left = is_at_left() ? x + size + 0.4f * em : x - 0.4f * em - width;
    const float middle = margin + 0.5f * size;
    list.AddRectFilled({left, middle - 0.8f * em}, {left + width, middle + 0.8f * em},
                       dance_ink::kPaper, 0.8f * em);
    list.AddCircleFilled({left + 0.8f * em, middle}, 0.36f * em, dance_ink::kBad, 20);
    list.AddText({std::round(left + 1.4f * em), std::round(middle - 0.5f * em)}, dance_ink::kText,
                 time.c_str());
  }
  if (!mouse_moved_.is_set() || now - mouse_moved_ > kCornerHolds) return;
  ImGui::SetNextWindowPos({x, margin});
  ImGui::SetNextWindowSize({size, size});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  if (ImGui::Begin("dance-corner", nullptr, dance_ink::kWindow)) {
    const bool is_clicked = ImGui::InvisibleButton("open", {size, size});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({x, margin}, {x + size, margin + size},
                       ImGui::IsItemHovered() ? IM_COL32(52, 60, 78, 240) : dance_ink::kPaper,
                       0.4f * em);
    for (int i = -1; i <= 1; ++i) {
      const float y = std::round(margin + 0.5f * size + 0.5f * em * static_cast<float>(i));
      list.AddLine({x + 0.55f * em, y}, {x + size - 0.55f * em, y}, dance_ink::kText,
                   std::max(1.0f, std::round(0.14f * em)));
    }
    if (is_clicked) open(true);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void DancePanel::act(BannerAction action) {
  if (action == BannerAction::kLeave) needs_.wishes.leaves = true;
  if (action == BannerAction::kDrawPlainly) needs_.wishes.draws_plainly = true;
  if (action == BannerAction::kUnmute) ++needs_.wishes.mute_presses;
}

// At the top, in the middle of what the column leaves; two lines and a button.
void DancePanel::draw_banner(const PanelFrame& frame) {
  const auto kind = banners_.choose(watch_.facts());
  if (!kind) return;
  const Banner banner = banner_of(*kind, watch_.facts(), texts_);
  const float em = frame.small_font->FontSize, margin = 0.7f * em;
  const float column = is_open_ ? dance_ink::column_width(em, frame.width_px) : 0.0f;
  float left = is_at_left() ? column : 0.0f;
  const float right = frame.width_px - (is_at_left() ? 0.0f : column);
  // Beside the figures, where that leaves enough.
  if (right - frame.figures_px > kLeastBanner_em * em) left = std::max(left, frame.figures_px);
  const float width = std::min(kBanner_em * em, right - left - 4.0f * margin);
  const float middle = 0.5f * (left + right);
  ImGui::SetNextWindowPos({std::round(middle - 0.5f * width), margin});
  ImGui::SetNextWindowSize({width, banner_px_ > 0.0f ? banner_px_ : 6.0f * em});
  if (ImGui::Begin("dance-banner", nullptr, dance_ink::kWindow)) {
    dance_ink::Paper paper(width);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImU32 ink = banner.is_grave ? dance_ink::kBad : dance_ink::kFair;
    dance_ink::draw_quality(*ImGui::GetWindowDrawList(),
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
    const Text label = banner.action == BannerAction::kLeave         ? Text::kLeave
                       : banner.action == BannerAction::kDrawPlainly ? Text::kDanceDrawPlainly
                                                                     : Text::kDanceUnmuteMe;
    if (banner.action != BannerAction::kNone &&
        controls_.button("act", texts_[label], PanelControls::Look::kStrong))
      act(banner.action);
    banner_px_ = ImGui::GetCursorPosY() + 0.4f * em;
    ImGui::SetCursorPos({width - close - 0.5f * em, 0.45f * em});
    if (controls_.button("close", "x", PanelControls::Look::kQuiet)) {
      banners_.close(*kind);
      if (*kind == BannerKind::kRecordingFailed) recording_.forget_trouble();
    }
    paper.end(banner_px_, dance_ink::kPaper, 0.5f * em);
  }
  ImGui::End();
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
