#include "viewer/dance_panel/dance_panel.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/printable.h"
#include "viewer/dance_panel/panel_style.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 5> kDanceKeys{{{"Esc", Text::kDoDancePanel},
                                             {"Y", Text::kDoMuteMusic},
                                             {"↑ ↓", Text::kDoControls},
                                             {"← →", Text::kDoQuieter},
                                             {"", Text::kDoPress, Text::kKeyEnter}}};
constexpr float kFewestRows_em = 5.0f;
constexpr float kMusicStep = 0.05f;

void push_style(float em) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.9f * em, 0.75f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.6f * em, 0.28f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.5f * em, 0.35f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 0.8f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.3f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_ScrollbarSize, 0.6f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_Text, panel_style::kText);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(52, 60, 78, 255));
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, panel_style::kAccent);
  ImGui::PushStyleColor(ImGuiCol_Separator, IM_COL32(255, 255, 255, 40));
  ImGui::PushStyleColor(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
}
void pop_style() {
  ImGui::PopStyleColor(5);
  ImGui::PopStyleVar(7);
}

// 0 for what is hardly heard, 1 for as loud as speech is.
float loudness(int level_dbfs) {
  return std::clamp((static_cast<float>(level_dbfs) + 60.0f) / 50.0f, 0.0f, 1.0f);
}

void section(const char* words) {
  ImGui::Separator();
  panel_style::text(panel_style::kQuiet, words);
}

}  // namespace

std::span<const KeyHelp> DancePanel::keys() const { return kDanceKeys; }

void DancePanel::open(bool is_open) {
  is_open_ = is_open;
  to_be_removed_ = GuestId();
  if (is_open) return;
  controls_.let_go();
  own_.close();
}

bool DancePanel::on_key(const KeyPress& press) {
  const bool is_enter = press.key == GLFW_KEY_ENTER || press.key == GLFW_KEY_KP_ENTER;
  if (needs_.wishes.closing == Closing::kAsked && !press.is_repeat &&
      (is_enter || press.key == GLFW_KEY_ESCAPE)) {
    answer_closing(is_enter);
    return true;
  }
  if (is_open_ && own_.on_key(press)) return true;
  if (press.key == GLFW_KEY_ESCAPE && !press.is_repeat) {
    open(!is_open_);
    return true;
  }
  if (press.key == GLFW_KEY_Y && !press.has_control) {
    if (!press.is_repeat) music_.toggle_mute();
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
  names_ = frame.scene.names;
  records_.take(needs_.board, now);
  records_.judge(needs_.figures, frame.scene, now);
  recording_.work(now);
  needs_.board.set_recording(recording_.state() != DanceRecording::State::kIdle);
  watch_.set_recording_trouble(recording_.trouble());
  watch_.update(records_, frame.scene, needs_.drawing, needs_.wall ? needs_.wall() : Duration(),
                now);
  arrivals_.work(records_, now);
  removal_.follow(records_.link(), needs_.board, now);
  tell_volumes_anew(frame.scene);
  music_.work(is_open_, now);
  own_.work();
  count_ = count_in_.at(frame.scene.music);
  note_mouse(now);
}

void DancePanel::draw(const PanelFrame& frame) {
  if (frame.small_font == nullptr) return;
  work(frame);
  ImGui::PushFont(frame.small_font);
  push_style(frame.small_font->FontSize);
  controls_.begin();
  draw_arrivals(frame, draw_recorders(frame, draw_banner(frame)));
  draw_slow_note(frame);
  draw_closing(frame);
  if (is_open_)
    draw_column(frame);
  else
    draw_corner(frame);
  controls_.end();
  draw_count(frame);
  pop_style();
  ImGui::PopFont();
}

void DancePanel::draw_column(const PanelFrame& frame) {
  const float em = frame.small_font->FontSize, margin = 0.7f * em;
  const float width = panel_style::column_width(em, frame.width_px);
  const float most = frame.height_px - 2.0f * margin;
  const float x = is_at_left() ? margin : frame.width_px - margin - width;
  ImGui::SetNextWindowPos({std::round(x), margin});
  ImGui::SetNextWindowSize({width, last_height_px_ > 0.0f ? last_height_px_ : most});
  if (ImGui::Begin("dance", nullptr, panel_style::kWindow)) {
    panel_style::PanelBackground background(width);
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
    background.end(last_height_px_, panel_style::kBackground, 0.5f * em);
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
    list.AddCircleFilled(centre, 0.42f * em, panel_style::kTrough, 24);
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
  const bool has_own = has_own_song();
  const bool finds = finds_beat(frame);
  if (!music && !has_own) {
    panel_style::text(panel_style::kText,
                      texts_[finds ? Text::kDanceFindsBeat : Text::kDanceNoMusic]);
    draw_band();
    return;
  }
  const float width = ImGui::GetContentRegionAvail().x;
  const bool has_title = records_.music() && !records_.music()->title.view().empty();
  const std::string title = has_title ? printable(records_.music()->title.view())
                                      : band_title().value_or(texts_[Text::kDanceUntitled]);
  ImGui::TextUnformatted(panel_style::fitted(title, width).c_str());
  if (music) {
    draw_lamps(*music);
    const std::string bpm = std::to_string(std::lround(60.0 * music->beats_per_second));
    ImGui::SameLine();
    panel_style::text(panel_style::kQuiet, texts_.say(Text::kDanceTempo, {bpm}).c_str());
  } else if (finds) {
    panel_style::text(panel_style::kQuiet, texts_[Text::kDanceFindsBeat]);
  }
  if (music_.is_there()) draw_music_volume(frame.scene.time);
  draw_band();
  if (has_own) draw_own_song();
  if (!CountIn::is_possible(music)) return;
  const bool waits = count_in_.is_asked();
  if (controls_.button("count-in", texts_[waits ? Text::kDanceCountWaits : Text::kDanceCountIn])) {
    if (waits)
      count_in_.stop();
    else
      count_in_.ask(music);
  }
}

void DancePanel::draw_music_volume(MonoTime now) {
  auto volume = music_.is_muted() ? 0.0f : static_cast<float>(music_.volume());
  const std::string words =
      music_.is_muted()
          ? std::string(texts_[Text::kDanceMusicMuted])
          : texts_.say(Text::kDanceMusicVolume, {std::to_string(std::lround(100.0f * volume))});
  if (controls_.slider("music-volume",
                       ImGui::GetContentRegionAvail().x - 0.3f * ImGui::GetFontSize(), volume, 0.0f,
                       1.0f, kMusicStep, words.c_str()))
    music_.set(static_cast<double>(volume), now);
}

// Of several voices of this house the first, as the keys.
void DancePanel::draw_own(const PanelFrame& frame) {
  section(texts_[Text::kDanceYou]);
  if (frame.scene.voices.empty()) {
    panel_style::text(panel_style::kQuiet, texts_[Text::kDanceNoVoice]);
    return draw_voice_switch(GuestId(), frame.scene.time);
  }
  const float em = ImGui::GetFontSize();
  const SceneVoice& voice = frame.scene.voices.front();
  if (voice.has_no_sound()) {
    panel_style::text(panel_style::kFair, texts_[Text::kBannerNoSound]);
    return draw_voice_switch(voice.guest, frame.scene.time);
  }
  const bool is_off = voice.is_muted || voice.is_deafened;
  const auto level = records_.level_of(voice.guest, frame.scene.time);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  panel_style::draw_level(*ImGui::GetWindowDrawList(), {low.x, low.y + 0.3f * em},
                          {ImGui::GetContentRegionAvail().x, 0.4f * em},
                          level ? loudness(level->level_dbfs) : 0.0f,
                          is_off || !voice.is_heard ? panel_style::kQuiet : panel_style::kGood);
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
  draw_voice_switch(voice.guest, frame.scene.time);
  if (!is_off && voice.is_push_to_talk)
    panel_style::text(voice.is_heard ? panel_style::kGood : panel_style::kQuiet,
                      texts_[voice.is_heard ? Text::kDanceTalking : Text::kDanceTalkHint]);
}

// `speaker`: whose voice runs here; not set: nobody's.
void DancePanel::draw_voice_switch(const GuestId& speaker, MonoTime now) {
  const GuestId& guest = own_.voice_guest(records_.guests(), now);
  if (!guest.is_set() || (speaker.is_set() && speaker != guest)) return;
  const bool is_on = speaker.is_set();
  const char* label = texts_[is_on ? Text::kOwnVoiceOff : Text::kOwnVoiceOn];
  if (is_on) controls_.flow(controls_.width_of(label));
  if (controls_.button("voice-switch", label)) own_.switch_voice(guest, !is_on);
}

void DancePanel::draw_footer(const PanelFrame& frame) {
  const MonoTime now = frame.scene.time;
  ImGui::Separator();
  if (const std::string words = removal_.words(names_, texts_, now); !words.empty())
    panel_style::text(panel_style::kText, words.c_str());
  if (!music_.trouble().empty())
    panel_style::text(panel_style::kFair, printable(music_.trouble()).c_str());
  if (!voice_trouble_.empty())
    panel_style::text(panel_style::kFair, printable(voice_trouble_).c_str());
  const auto state = recording_.state();
  if (state == DanceRecording::State::kRunning)
    panel_style::text(panel_style::kQuiet,
                      texts_.say(Text::kDanceRecordTo, {printable(recording_.file())}).c_str());
  else if (state == DanceRecording::State::kIdle && recording_.is_saved())
    panel_style::text(panel_style::kQuiet,
                      texts_.say(Text::kDanceRecorded, {printable(recording_.file())}).c_str());
  if (state == DanceRecording::State::kRunning) {
    const std::string label =
        texts_.say(Text::kDanceRecordStop, {panel_style::clock_text(recording_.elapsed(now))});
    if (controls_.button("record", label.c_str(), PanelControls::Look::kWarning))
      recording_.stop(now);
  } else if (state == DanceRecording::State::kStopping) {
    controls_.button("record", texts_[Text::kDanceRecordEnds]);
  } else if (controls_.button("record", texts_[Text::kDanceRecord])) {
    recording_.start(now);
  }
  ImGui::SameLine();
  if (controls_.button("picture", texts_[Text::kDancePicture])) needs_.wishes.takes_picture = true;
  const float leave = controls_.width_of(texts_[Text::kLeave]);
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - leave);
  if (controls_.button("leave", texts_[Text::kLeave], PanelControls::Look::kStrong))
    needs_.wishes.leaves = true;
}

}  // namespace dance
