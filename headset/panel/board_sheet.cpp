#include "headset/panel/board_sheet.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "formats/body/guest_look.h"
#include "viewer/overlay/overlay_fonts.h"
#include "viewer/overlay/voice_mark.h"

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr int kSheetWidth_px = 1024, kSheetHeight_px = 2048;
constexpr float kPanelWidth_px = 800.0f, kPanelHeight_px = 560.0f;  // as wide to high as the panel
constexpr float kTagsFrom_px = 576.0f;
constexpr float kTagWidth_px = 512.0f, kTagHeight_px = 64.0f;
constexpr int kTagsInRow = 2;
static_assert(BoardSheet::kMostTags / kTagsInRow * 64 + 576 <= kSheetHeight_px);
// A tag of a metre away; it keeps its size on the eye's picture up to kTagGrows_m.
constexpr float kTagHeight_m = 0.055f;
constexpr float kTagNear_m = 1.2f, kTagGrows_m = 8.0f;
constexpr float kOverHead_m = -0.03f;

constexpr ImU32 kBack = IM_COL32(16, 18, 26, 250), kInk = IM_COL32(240, 240, 245, 255);
constexpr ImU32 kSoft = IM_COL32(170, 175, 190, 255), kWarm = IM_COL32(255, 196, 120, 255);
constexpr ImU32 kButton = IM_COL32(48, 54, 74, 255), kHover = IM_COL32(84, 98, 140, 255);
constexpr ImU32 kOn = IM_COL32(150, 60, 60, 255), kDot = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kRecords = IM_COL32(242, 61, 54, 255);

ImVec2 tag_at(std::size_t place) {
  const auto column = static_cast<float>(place % kTagsInRow);
  const auto row = static_cast<float>(place / kTagsInRow);
  return {column * kTagWidth_px, kTagsFrom_px + row * kTagHeight_px};
}

// Of words that fit the width, from one size down to a smaller one.
float size_that_fits(ImFont& font, const std::string& words, float width_px, float wanted_px) {
  const float width = font.CalcTextSizeA(wanted_px, 1e5f, 0.0f, words.c_str()).x;
  return width <= width_px ? wanted_px : std::max(0.5f * wanted_px, wanted_px * width_px / width);
}

}  // namespace

Result<std::unique_ptr<BoardSheet>> BoardSheet::create(Language language) {
  std::unique_ptr<BoardSheet> sheet(new BoardSheet(language));
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  sheet->large_ = add_text_font(atlas, 44.0f);
  sheet->small_ = add_text_font(atlas, 32.0f);
  if (auto begun = sheet->imgui_.begin("the panel"); !begun)
    return tl::make_unexpected(begun.error());
  sheet->make_texture();
  return sheet;
}

void BoardSheet::make_texture() {
  texture_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, kSheetWidth_px, kSheetHeight_px, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  framebuffer_ = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
}

std::string BoardSheet::content_of(const WristPanel& panel, const PanelWords& words,
                                   std::span<const SceneGuest> guests) const {
  std::string content;
  for (const SceneGuest& guest : guests) {
    content += guest.id.view();
    content += ' ';
    content += shown_name(names_, guest.id, texts_);
    content += guest.is_recording ? 'r' : '-';
    content += static_cast<char>('0' + static_cast<int>(guest.voice_mark));
    content += guest.voice > 0.05f ? '+' : '-';
    content += guest.hides_head ? 'h' : '-';
  }
  if (panel.opacity() <= 0.0f) return content + "|";
  content += "|" + words.title + "|" + std::to_string(words.tracked) + "," +
             std::to_string(static_cast<int>(words.advice)) + "," +
             std::to_string(std::lround(20.0f * words.progress));
  content += words.has_voice ? 'v' : '-';
  content += words.is_muted ? 'm' : '-';
  content +=
      static_cast<char>('0' + (panel.hovered() ? 1 + static_cast<int>(*panel.hovered()) : 0));
  content += std::to_string(static_cast<int>(40.0f * panel.held(PanelAction::kLeave)));
  if (panel.pointer())
    content += std::to_string(std::lround(500.0f * panel.pointer()->x())) + "," +
               std::to_string(std::lround(500.0f * panel.pointer()->y()));
  return content;
}

void BoardSheet::draw(const WristPanel& panel, const PanelWords& words,
                      std::span<const SceneGuest> guests, const ShownNames& names) {
  names_ = names;
  const std::string content = content_of(panel, words, guests);
  tag_widths_px_.resize(guests.size(), 0.0f);
  if (content == drawn_) return;
  drawn_ = content;
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, kSheetWidth_px, kSheetHeight_px);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  imgui_.begin_frame(kSheetWidth_px, kSheetHeight_px);
  if (panel.opacity() > 0.0f) draw_panel(panel, words);
  std::fill(tag_widths_px_.begin(), tag_widths_px_.end(), 0.0f);
  for (std::size_t i = 0; i < std::min(guests.size(), kMostTags); ++i)
    if (!guests[i].hides_head) draw_tag(i, guests[i]);
  imgui_.end_frame();
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glGenerateMipmap(GL_TEXTURE_2D);
}

void BoardSheet::draw_button(PanelAction action, const char* label, bool is_on,
                             const WristPanel& panel) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const PanelArea area = WristPanel::area_of(action);
  const ImVec2 low(area.u0 * kPanelWidth_px, area.v0 * kPanelHeight_px);
  const ImVec2 high(area.u1 * kPanelWidth_px, area.v1 * kPanelHeight_px);
  const bool is_hovered = panel.hovered() == action;
  list.AddRectFilled(low, high, is_on ? kOn : is_hovered ? kHover : kButton, 22.0f);
  if (const float held = panel.held(action); held > 0.0f)
    list.AddRectFilled(low, {low.x + held * (high.x - low.x), high.y}, kOn, 22.0f);
  if (is_hovered) list.AddRect(low, high, kInk, 22.0f, 0, 4.0f);
  const float size = size_that_fits(*large_, label, high.x - low.x - 30.0f, 44.0f);
  const ImVec2 text = large_->CalcTextSizeA(size, 1e5f, 0.0f, label);
  list.AddText(large_, size, {0.5f * (low.x + high.x - text.x), 0.5f * (low.y + high.y - text.y)},
               kInk, label);
}

void BoardSheet::draw_panel(const WristPanel& panel, const PanelWords& words) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({0.0f, 0.0f}, {kPanelWidth_px, kPanelHeight_px}, kBack, 36.0f);
  const auto line = [&](ImFont& font, float size, float y, ImU32 colour, const std::string& text) {
    list.AddText(&font, size_that_fits(font, text, kPanelWidth_px - 60.0f, size), {30.0f, y},
                 colour, text.c_str());
  };
  line(*large_, 44.0f, 22.0f, kInk, words.title);
  line(*small_, 32.0f, 84.0f, kSoft,
       texts_.say(Text::kHeadsetPoints, {std::to_string(words.tracked)}));
  if (words.advice != PanelWords::Advice::kNone) {
    const bool waits = words.advice == PanelWords::Advice::kStandInTPose;
    line(*small_, 32.0f, 134.0f, kWarm,
         texts_[waits ? Text::kHeadsetTPose : Text::kHeadsetTPoseSoon]);
    const float right = 30.0f + words.progress * (kPanelWidth_px - 60.0f);
    if (waits) list.AddRectFilled({30.0f, 184.0f}, {right, 194.0f}, kWarm, 5.0f);
  }
  const Text voice = !words.has_voice ? Text::kHeadsetNoVoice
                     : words.is_muted ? Text::kHeadsetUnmute
                                      : Text::kHeadsetMute;
  draw_button(PanelAction::kMute, texts_[voice], words.is_muted, panel);
  draw_button(PanelAction::kRecentre, texts_[Text::kHeadsetRecentre], false, panel);
  draw_button(PanelAction::kCalibrate, texts_[Text::kHeadsetCalibrate], false, panel);
  draw_button(PanelAction::kLeave, texts_[Text::kHeadsetHoldToLeave], false, panel);
  if (panel.pointer())
    list.AddCircleFilled(
        {panel.pointer()->x() * kPanelWidth_px, panel.pointer()->y() * kPanelHeight_px}, 9.0f,
        kDot);
}

void BoardSheet::draw_tag(std::size_t place, const SceneGuest& guest) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 at = tag_at(place);
  const char* name = shown_name(names_, guest.id, texts_).data();  // ends with a zero
  constexpr float kPad = 20.0f, kDotRadius = 9.0f;
  const bool has_mark = guest.voice_mark != VoiceMark::kNone;
  const float before = kPad + 3.0f * kDotRadius + (has_mark ? 48.0f : 0.0f);
  const float after = guest.is_recording ? kPad + 48.0f : kPad;
  const float size = size_that_fits(*large_, name, kTagWidth_px - before - after, 44.0f);
  const ImVec2 text = large_->CalcTextSizeA(size, 1e5f, 0.0f, name);
  const float width = std::min(kTagWidth_px, before + text.x + after);
  tag_widths_px_[place] = width;
  const float middle = at.y + 0.5f * kTagHeight_px;
  list.AddRectFilled({at.x, at.y + 2.0f}, {at.x + width, at.y + kTagHeight_px - 2.0f}, kBack,
                     0.5f * kTagHeight_px - 2.0f);
  const Eigen::Vector3f colour = look_of(guest.id).tag;
  const ImU32 dot =
      ImGui::ColorConvertFloat4ToU32(ImVec4(colour.x(), colour.y(), colour.z(), 1.0f));
  list.AddCircleFilled({at.x + kPad + kDotRadius, middle}, kDotRadius, dot);
  if (guest.voice > 0.05f)
    list.AddCircle({at.x + kPad + kDotRadius, middle}, kDotRadius + 7.0f, kInk, 24, 3.0f);
  if (has_mark)
    draw_voice_mark(list, guest.voice_mark, {at.x + before - 24.0f, middle}, 36.0f, 1.0f);
  list.AddText(large_, size, {at.x + before, middle - 0.5f * text.y}, kInk, name);
  if (guest.is_recording)
    list.AddCircleFilled({at.x + width - kPad - 12.0f, middle}, 12.0f, kRecords, 24);
}

void BoardSheet::append_tags(std::span<const SceneGuest> guests,
                             std::span<const Vector3f> anchors_W_m, const Vector3f& eye_W_m,
                             std::vector<Board>& boards) const {
  const std::size_t first = boards.size();
  const std::size_t count = std::min({guests.size(), anchors_W_m.size(), tag_widths_px_.size()});
  for (std::size_t i = 0; i < count; ++i) {
    if (tag_widths_px_[i] <= 0.0f) continue;
    Board board;
    const float distance = (eye_W_m - anchors_W_m[i]).norm();
    const float grow = std::clamp(distance, kTagNear_m, kTagGrows_m) / kTagNear_m;
    board.height_m = kTagHeight_m * grow;
    board.width_m = board.height_m * tag_widths_px_[i] / kTagHeight_px;
    board.centre_W_m = anchors_W_m[i] + Vector3f(0.0f, kOverHead_m + 0.5f * board.height_m, 0.0f);
    // Upright, and turned to the eye.
    Vector3f towards = eye_W_m - board.centre_W_m;
    towards.y() = 0.0f;
    if (towards.norm() < 0.05f) continue;
    towards.normalize();
    board.axes_W.col(2) = towards;
    board.axes_W.col(1) = Vector3f::UnitY();
    board.axes_W.col(0) = Vector3f::UnitY().cross(towards);
    const ImVec2 at = tag_at(i);
    board.u0 = at.x / kSheetWidth_px;
    board.u1 = (at.x + tag_widths_px_[i]) / kSheetWidth_px;
    board.v0 = at.y / kSheetHeight_px;
    board.v1 = (at.y + kTagHeight_px) / kSheetHeight_px;
    board.opacity = guests[i].opacity;
    boards.push_back(board);
  }
  std::sort(boards.begin() + static_cast<std::ptrdiff_t>(first), boards.end(),
            [&](const Board& a, const Board& b) {
              return (a.centre_W_m - eye_W_m).squaredNorm() >
                     (b.centre_W_m - eye_W_m).squaredNorm();
            });
}

void BoardSheet::append_panel(const WristPanel& panel, std::vector<Board>& boards) const {
  if (panel.opacity() <= 0.0f) return;
  Board board;
  board.centre_W_m = panel.board().centre_W_m;
  board.axes_W = panel.board().axes_W;
  board.width_m = WristPanel::kWidth_m;
  board.height_m = WristPanel::kHeight_m;
  board.u1 = kPanelWidth_px / kSheetWidth_px;
  board.v1 = kPanelHeight_px / kSheetHeight_px;
  board.opacity = panel.opacity();
  boards.push_back(board);
}

}  // namespace dance
