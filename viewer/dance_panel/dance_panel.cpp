#include "viewer/dance_panel/dance_panel.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/printable.h"
#include "viewer/dance_panel/dance_ink.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 4> kDanceKeys{{{"Esc", "this panel: guests, music, record, leave"},
                                             {"Up  Down", "in it: one control to the next"},
                                             {"Left  Right", "in it: softer, louder"},
                                             {"Enter", "in it: press"}}};
constexpr float kWidth_em = 21.5f;
constexpr float kMostShare = 0.36f;  // of the window's width
constexpr float kFewestRows_em = 5.0f;
constexpr Duration kCornerHolds = Duration::s(3);
constexpr ImGuiWindowFlags kWindow =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
    ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar |
    ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoFocusOnAppearing;

void push_style(float em) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.9f * em, 0.75f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.6f * em, 0.28f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.5f * em, 0.35f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 0.8f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.3f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, 0.6f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_Text, dance_ink::kText);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(52, 60, 78, 255));
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, dance_ink::kAccent);
  ImGui::PushStyleColor(ImGuiCol_Separator, IM_COL32(255, 255, 255, 40));
  ImGui::PushStyleColor(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
}
void pop_style() {
  ImGui::PopStyleColor(5);
  ImGui::PopStyleVar(7);
}

// Paper of its own, that lies under a content whose height is known only behind it.
class Paper {
 public:
  explicit Paper(float width) : list_(*ImGui::GetWindowDrawList()), width_(width) {
    list_.ChannelsSplit(2);
    list_.ChannelsSetCurrent(1);
  }
  void end(float height, ImU32 ink, float radius) {
    list_.ChannelsSetCurrent(0);
    const ImVec2 low = ImGui::GetWindowPos();
    list_.PushClipRectFullScreen();
    list_.AddRectFilled(low, {low.x + width_, low.y + height}, ink, radius);
    list_.PopClipRect();
    list_.ChannelsMerge();
  }

 private:
  ImDrawList& list_;
  float width_;
};

std::string clock_text(Duration elapsed) {
  const std::int64_t seconds = elapsed.count_ms() / 1000;
  return seconds < 3600
             ? fmt::format("{}:{:02}", seconds / 60, seconds % 60)
             : fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

// 0 for what is hardly heard, 1 for as loud as speech is.
float loudness(int level_dbfs) {
  return std::clamp((static_cast<float>(level_dbfs) + 60.0f) / 50.0f, 0.0f, 1.0f);
}

void section(const char* words) {
  ImGui::Separator();
  dance_ink::text(dance_ink::kQuiet, words);
}

}  // namespace

std::span<const KeyHelp> DancePanel::keys() const { return kDanceKeys; }

void DancePanel::open(bool is_open) {
  is_open_ = is_open;
  to_be_removed_ = GuestId();
  if (!is_open) controls_.let_go();
}

bool DancePanel::on_key(const KeyPress& press) {
  if (press.key == GLFW_KEY_ESCAPE && !press.is_repeat) {
    open(!is_open_);
    return true;
  }
  return is_open_ && controls_.on_key(press);
}

bool DancePanel::is_at_left() const {
  return std::any_of(rivals_.begin(), rivals_.end(),
                     [](const WindowPanel* rival) { return rival->is_open(); });
}

void DancePanel::note_mouse(MonoTime now) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool is_first = mouse_.x < -1e5f;
  if (mouse.x == mouse_.x && mouse.y == mouse_.y) return;
  mouse_ = mouse;
  if (!is_first && ImGui::IsMousePosValid(&mouse)) mouse_moved_ = now;
}

void DancePanel::work(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  records_.take(needs_.board, now);
  records_.judge(needs_.figures, frame.scene, now);
  recording_.work(now);
  watch_.set_recording_trouble(recording_.trouble());
  watch_.update(records_, frame.scene, needs_.drawing, needs_.wall ? needs_.wall() : Duration(),
                now);
  removal_.follow(records_.link(), needs_.board, now);
  tell_volumes_anew(frame.scene);
  count_ = count_in_.at(frame.scene.music);
  note_mouse(now);
}

void DancePanel::draw(const PanelFrame& frame) {
  if (frame.small_font == nullptr) return;
  work(frame);
  ImGui::PushFont(frame.small_font);
  push_style(frame.small_font->FontSize);
  controls_.begin();
  draw_banner(frame);
  if (is_open_)
    draw_column(frame);
  else
    draw_corner(frame);
  controls_.end();
  draw_count(frame);
  pop_style();
  ImGui::PopFont();
}

// The way in for the mouse, and the mark of a recording.
void DancePanel::draw_corner(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  const float em = frame.small_font->FontSize, margin = 0.7f * em, size = 2.2f * em;
  const float x = is_at_left() ? margin : frame.width_px - margin - size;
  if (recording_.state() != DanceRecording::State::kIdle) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const std::string time = clock_text(recording_.elapsed(now));
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
  if (ImGui::Begin("dance-corner", nullptr, kWindow)) {
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
  const float column = is_open_ ? std::min(kWidth_em * em, kMostShare * frame.width_px) : 0.0f;
  const float room = frame.width_px - column - 4.0f * margin;
  const float width = std::min(34.0f * em, std::max(room, 0.5f * frame.width_px));
  const float middle = 0.5f * (frame.width_px - column) + (is_at_left() ? column : 0.0f);
  ImGui::SetNextWindowPos({std::round(middle - 0.5f * width), margin});
  ImGui::SetNextWindowSize({width, banner_px_ > 0.0f ? banner_px_ : 6.0f * em});
  if (ImGui::Begin("dance-banner", nullptr, kWindow)) {
    Paper paper(width);
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

void DancePanel::draw_column(const PanelFrame& frame) {
  const float em = frame.small_font->FontSize, margin = 0.7f * em;
  const float width = std::min(std::max(kWidth_em * em, 0.0f), kMostShare * frame.width_px);
  const float most = frame.height_px - 2.0f * margin;
  const float x = is_at_left() ? margin : frame.width_px - margin - width;
  ImGui::SetNextWindowPos({std::round(x), margin});
  ImGui::SetNextWindowSize({width, last_height_px_ > 0.0f ? last_height_px_ : most});
  if (ImGui::Begin("dance", nullptr, kWindow)) {
    Paper paper(width);
    ImGui::PushFont(frame.large_font);
    ImGui::TextUnformatted(texts_[Text::kDancePanel]);
    ImGui::PopFont();
    const float close = controls_.width_of("x");
    ImGui::SameLine(width - close - 0.6f * em);
    if (controls_.mouse_button("close", "x", PanelControls::Look::kQuiet)) open(false);
    draw_music(frame);
    draw_own(frame);
    section(texts_.say(Text::kDanceGuests, {std::to_string(records_.guests().size())}).c_str());
    // The footer is as high as it was, or two lines and its buttons.
    const float footer =
        footer_px_ > 0.0f ? footer_px_ : 2.0f * ImGui::GetFrameHeight() + 2.0f * em;
    const float left = most - ImGui::GetCursorPosY() - footer;
    draw_guests(frame, std::clamp(guests_height(), 0.0f, std::max(left, kFewestRows_em * em)));
    const float begin = ImGui::GetCursorPosY();
    draw_footer(frame);
    footer_px_ = ImGui::GetCursorPosY() - begin + 0.5f * em;
    last_height_px_ = std::min(most, ImGui::GetCursorPosY() + 0.4f * em);
    paper.end(last_height_px_, dance_ink::kPaper, 0.5f * em);
  }
  ImGui::End();
}

void DancePanel::draw_lamps(const SceneMusic& music) const {
  const float em = ImGui::GetFontSize();
  const int lamps = std::clamp(music.beats_per_bar, 1, 16);
  const double in_bar = music.beats - std::floor(music.beats / lamps) * lamps;
  const int lit = std::min(static_cast<int>(in_bar), lamps - 1);
  const auto since = static_cast<float>(in_bar - lit);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int i = 0; i < lamps; ++i) {
    const ImVec2 centre{low.x + (0.6f + 1.35f * static_cast<float>(i)) * em, low.y + 0.65f * em};
    list.AddCircleFilled(centre, 0.42f * em, dance_ink::kTrough, 24);
    if (i != lit) continue;
    const int alpha = static_cast<int>(255.0f * (1.0f - 0.6f * since));
    list.AddCircleFilled(centre, 0.5f * em,
                         i == 0 && music.beats_per_bar > 0 ? IM_COL32(95, 211, 141, alpha)
                                                           : IM_COL32(111, 183, 255, alpha),
                         24);
  }
  ImGui::Dummy({(1.35f * static_cast<float>(lamps)) * em, 1.3f * em});
}

void DancePanel::draw_music(const PanelFrame& frame) {
  section(texts_[Text::kDanceMusic]);
  const auto& music = frame.scene.music;
  if (!music) {
    dance_ink::text(dance_ink::kText, texts_[Text::kDanceNoMusic]);
    return;
  }
  const float width = ImGui::GetContentRegionAvail().x;
  const bool has_title = records_.music() && !records_.music()->title.view().empty();
  const std::string title = has_title ? printable(records_.music()->title.view())
                                      : std::string(texts_[Text::kDanceUntitled]);
  ImGui::TextUnformatted(dance_ink::fitted(title, width).c_str());
  draw_lamps(*music);
  const std::string bpm = std::to_string(std::lround(60.0 * music->beats_per_second));
  ImGui::SameLine();
  dance_ink::text(dance_ink::kQuiet, texts_.say(Text::kDanceTempo, {bpm}).c_str());
  if (!CountIn::is_possible(music)) return;
  const bool waits = count_in_.is_asked();
  if (controls_.button("count-in", texts_[waits ? Text::kDanceCountWaits : Text::kDanceCountIn])) {
    if (waits)
      count_in_.stop();
    else
      count_in_.ask(music);
  }
}

// Of several voices of this house the first, as the keys.
void DancePanel::draw_own(const PanelFrame& frame) {
  section(texts_[Text::kDanceYou]);
  if (frame.scene.voices.empty()) {
    dance_ink::text(dance_ink::kQuiet, texts_[Text::kDanceNoVoice]);
    return;
  }
  const float em = ImGui::GetFontSize();
  const SceneVoice& voice = frame.scene.voices.front();
  const bool is_off = voice.is_muted || voice.is_deafened;
  const auto level = records_.level_of(voice.guest, frame.scene.time);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  dance_ink::draw_level(*ImGui::GetWindowDrawList(), {low.x, low.y + 0.3f * em},
                        {ImGui::GetContentRegionAvail().x, 0.4f * em},
                        level ? loudness(level->level_dbfs) : 0.0f,
                        is_off || !voice.is_heard ? dance_ink::kQuiet : dance_ink::kGood);
  ImGui::Dummy({1.0f, 0.8f * em});
  const Text microphone = is_off ? Text::kDanceMicrophoneOff : Text::kDanceMicrophoneOn;
  if (controls_.button("microphone", texts_[microphone],
                       is_off ? PanelControls::Look::kWarning : PanelControls::Look::kPlain))
    ++(voice.is_deafened ? needs_.wishes.deafen_presses : needs_.wishes.mute_presses);
  const Text speaker = voice.is_deafened ? Text::kDanceSpeakerOff : Text::kDanceSpeakerOn;
  controls_.flow(controls_.width_of(texts_[speaker]));
  if (controls_.button(
          "speaker", texts_[speaker],
          voice.is_deafened ? PanelControls::Look::kWarning : PanelControls::Look::kPlain))
    ++needs_.wishes.deafen_presses;
  if (!is_off && voice.is_push_to_talk)
    dance_ink::text(voice.is_heard ? dance_ink::kGood : dance_ink::kQuiet,
                    texts_[voice.is_heard ? Text::kDanceTalking : Text::kDanceTalkHint]);
}

void DancePanel::draw_footer(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  ImGui::Separator();
  if (const std::string words = removal_.words(texts_, now); !words.empty())
    dance_ink::text(dance_ink::kText, words.c_str());
  if (!voice_trouble_.empty()) dance_ink::text(dance_ink::kFair, printable(voice_trouble_).c_str());
  const auto state = recording_.state();
  if (state == DanceRecording::State::kRunning)
    dance_ink::text(dance_ink::kQuiet,
                    texts_.say(Text::kDanceRecordTo, {printable(recording_.file())}).c_str());
  else if (state == DanceRecording::State::kIdle && recording_.is_saved())
    dance_ink::text(dance_ink::kQuiet,
                    texts_.say(Text::kDanceRecorded, {printable(recording_.file())}).c_str());
  if (state == DanceRecording::State::kRunning) {
    const std::string label =
        texts_.say(Text::kDanceRecordStop, {clock_text(recording_.elapsed(now))});
    if (controls_.button("record", label.c_str(), PanelControls::Look::kWarning))
      recording_.stop(now);
  } else if (state == DanceRecording::State::kStopping) {
    controls_.button("record", texts_[Text::kDanceRecordEnds]);
  } else if (controls_.button("record", texts_[Text::kDanceRecord])) {
    recording_.start(now);
  }
  const float leave = controls_.width_of(texts_[Text::kLeave]);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - leave);
  if (controls_.button("leave", texts_[Text::kLeave], PanelControls::Look::kStrong))
    needs_.wishes.leaves = true;
}

}  // namespace dance
