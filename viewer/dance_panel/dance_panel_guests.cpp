// The guests of the dance panel: one line each, and what can be done about the chosen one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/body/guest_look.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/dance_panel/panel_style.h"
#include "viewer/words/shown_name.h"

namespace dance {
namespace {

constexpr float kRow_em = 1.6f;
constexpr float kGap_em = 0.1f;  // between rows
constexpr float kChoiceGap_em = 0.35f;
constexpr float kEnd_em = 0.3f;
constexpr float kLevelWidth_em = 2.6f;
constexpr float kIndent_em = 2.5f;
constexpr float kMostVolume = 2.0f;
constexpr float kVolumeStep = 0.1f;

ImU32 colour_of(const GuestId& guest) {
  const Eigen::Vector3f s = srgb_from_linear(look_of(guest).tag);
  return ImGui::ColorConvertFloat4ToU32(ImVec4(s.x(), s.y(), s.z(), 1.0f));
}

// The user's choice for a guest goes before the guest's own state.
std::optional<Text> mark_text(const DanceGuest& guest, const GuestChoice& choice) {
  if (choice.is_hidden) return Text::kDanceHidden;
  if (choice.is_voice_muted) return Text::kDanceMuted;
  if (!guest.is_remote) return std::nullopt;  // the panel's own part shows that
  switch (guest.voice_mark) {
    case VoiceMark::kDeafened:
      return Text::kDanceHearsNobody;
    case VoiceMark::kMuted:
      return Text::kDanceMutedSelf;
    case VoiceMark::kNoMicrophone:
      return Text::kDanceNoMicrophone;
    case VoiceMark::kTalking:
      return guest.voice > 0.0f ? std::nullopt : std::optional(Text::kDanceTalks);
    case VoiceMark::kNone:
    case VoiceMark::kWaiting:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::string DancePanel::removal_question(const DanceGuest& guest) const {
  return texts_.say(Text::kDanceRemoveSure, {shown_name(names_, guest.id, texts_)});
}

bool DancePanel::may_remove() const { return records_.link() && records_.link()->link.may_remove; }

// As draw_guest() draws it, so that the list is as high as its content in the first picture.
float DancePanel::guest_height(const DanceGuest& guest) const {
  const float em = ImGui::GetFontSize(), gap = kGap_em * em;
  float height = kRow_em * em + gap;
  const std::string words = quality_words(guest.quality.shown(), texts_);
  if (!words.empty())
    height += gap + panel_style::wrapped_height(words,
                                                ImGui::GetContentRegionAvail().x - kIndent_em * em);
  if (guest.id != chosen_) return height;
  const float line = ImGui::GetFrameHeight() + kChoiceGap_em * em;
  const float width = ImGui::GetContentRegionAvail().x - kIndent_em * em;
  if (guest.id == to_be_removed_)
    return height + line + kChoiceGap_em * em +
           panel_style::wrapped_height(removal_question(guest), width);
  const bool shows_roles = has_role_ && role_guest_ == guest.id;
  if (!guest.is_remote) return height + (shows_roles ? 4.0f : 2.0f) * line + own_.height_px();
  // As flow() puts the buttons.
  const float between = ImGui::GetStyle().ItemSpacing.x;
  const Text mute = records_.is_voice_muted(guest.id) ? Text::kDanceUnmute : Text::kDanceMute;
  float buttons =
      controls_.width_of(texts_[mute]) + between + controls_.width_of(texts_[Text::kDanceHide]);
  if (may_remove()) buttons += between + controls_.width_of(texts_[Text::kDanceRemove]);
  return height + (buttons > width ? 3.0f : 2.0f) * line;
}

float DancePanel::guests_height() const {
  float height = kEnd_em * ImGui::GetFontSize();
  for (const DanceGuest& guest : records_.guests()) height += guest_height(guest);
  return height;
}

void DancePanel::draw_guests(const PanelFrame& frame, float height) {
  if (records_.guests().empty()) {
    panel_style::text(panel_style::kQuiet, texts_[Text::kDanceNobody]);
    return;
  }
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                      {ImGui::GetStyle().ItemSpacing.x, kGap_em * ImGui::GetFontSize()});
  if (ImGui::BeginChild("guests", {0.0f, height}, false, ImGuiWindowFlags_NoNav))
    for (const DanceGuest& guest : records_.guests()) draw_guest(frame, guest);
  ImGui::Dummy({1.0f, (kEnd_em - kGap_em) * ImGui::GetFontSize()});
  ImGui::EndChild();
  ImGui::PopStyleVar();
}

void DancePanel::draw_guest(const PanelFrame& frame, const DanceGuest& guest) {
  const float em = ImGui::GetFontSize();
  const std::string name(shown_name(names_, guest.id, texts_));
  const GuestChoice& choice = records_.choice_of(guest.id);
  const QualityVerdict& quality = guest.quality.shown();
  ImGui::PushID(guest.id.c_str());
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  if (controls_.row("row", kRow_em * em)) {
    chosen_ = chosen_ == guest.id ? GuestId() : guest.id;
    to_be_removed_ = GuestId();
    own_.close();
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float middle = low.y + 0.5f * kRow_em * em, text_y = middle - 0.5f * em;
  panel_style::draw_quality(list, quality.level, {low.x + 0.55f * em, middle}, 0.34f * em);
  list.AddCircleFilled({low.x + 1.75f * em, middle}, 0.42f * em, colour_of(guest.id), 24);
  // From the right: the voice's level, or what was chosen.
  float right = low.x + width - 0.2f * em;
  const std::optional<Text> what = mark_text(guest, choice);
  const char* mark = what ? texts_[*what] : nullptr;
  if (mark != nullptr) {
    right -= ImGui::CalcTextSize(mark).x;
    list.AddText({std::round(right), std::round(text_y)}, panel_style::kQuiet, mark);
    right -= 0.5f * em;
  }
  if (!choice.is_voice_muted && guest.voice > 0.0f) {
    right -= kLevelWidth_em * em;
    panel_style::draw_level(list, {right, middle - 0.16f * em}, {kLevelWidth_em * em, 0.32f * em},
                            guest.voice, panel_style::kGood);
    right -= 0.5f * em;
  }
  const auto& recorders = frame.scene.recorders;
  if (std::find(recorders.begin(), recorders.end(), guest.id) != recorders.end()) {
    right -= 0.8f * em;
    list.AddCircleFilled({right + 0.4f * em, middle}, 0.36f * em, panel_style::kBad, 20);
    right -= 0.4f * em;
  }
  const float begin = low.x + kIndent_em * em;
  list.AddText({std::round(begin), std::round(text_y)},
               choice.is_hidden ? panel_style::kQuiet : panel_style::kText,
               panel_style::fitted(name, right - begin).c_str());
  const std::string words = quality_words(quality, texts_);
  if (!words.empty()) {
    ImGui::Indent(kIndent_em * em);
    panel_style::text(panel_style::colour_of(quality.level), words.c_str());
    ImGui::Unindent(kIndent_em * em);
  }
  if (chosen_ == guest.id) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        {ImGui::GetStyle().ItemSpacing.x, kChoiceGap_em * em});
    draw_choices(frame, guest);
    ImGui::PopStyleVar();
  }
  ImGui::PopID();
}

void DancePanel::draw_choices(const PanelFrame& frame, const DanceGuest& guest) {
  const float em = ImGui::GetFontSize();
  ImGui::Indent(kIndent_em * em);
  if (to_be_removed_ == guest.id) {
    draw_removal(guest, frame.scene.time);
    ImGui::Unindent(kIndent_em * em);
    return;
  }
  GuestChoice& choice = records_.choice_of(guest.id);
  if (guest.is_remote) {
    const Text label = choice.is_voice_muted ? Text::kDanceUnmute : Text::kDanceMute;
    if (controls_.button("mute", texts_[label])) {
      choice.is_voice_muted = !choice.is_voice_muted;
      tell_volume(frame.scene, guest.id);
    }
    controls_.flow(controls_.width_of(texts_[Text::kDanceHide]));
  } else {
    panel_style::text(panel_style::kQuiet, texts_[Text::kDanceYours]);
  }
  if (controls_.button("hide", texts_[choice.is_hidden ? Text::kDanceShow : Text::kDanceHide])) {
    choice.is_hidden = !choice.is_hidden;
    set_hidden(guest.id, choice.is_hidden);
  }
  draw_roles(guest, frame.scene.time);
  if (!guest.is_remote) own_.draw(controls_, guest.id, chosen_name(guest.id));
  if (guest.is_remote && may_remove()) {
    controls_.flow(controls_.width_of(texts_[Text::kDanceRemove]));
    if (controls_.button("remove", texts_[Text::kDanceRemove])) {
      to_be_removed_ = guest.id;
      is_removal_asked_ = true;
    }
  }
  if (guest.is_remote) {
    const std::string words = texts_.say(
        Text::kDanceVolume, {std::to_string(std::lround(100.0f * choice.heard_volume()))});
    if (controls_.slider("volume", ImGui::GetContentRegionAvail().x - 0.3f * em, choice.volume,
                         0.0f, kMostVolume, kVolumeStep, words.c_str())) {
      choice.is_voice_muted = false;
      tell_volume(frame.scene, guest.id);
    }
  }
  ImGui::Unindent(kIndent_em * em);
}

// Without the id that follows a name like another guest's.
std::string_view DancePanel::chosen_name(const GuestId& guest) const {
  std::string_view name = names_.find(guest);
  const std::string id = " (" + std::string(guest.view()) + ")";
  if (name.ends_with(id)) name.remove_suffix(id.size());
  return name;
}

void DancePanel::draw_removal(const DanceGuest& guest, MonoTime now) {
  panel_style::text(panel_style::kText, removal_question(guest).c_str());
  if (controls_.button("sure", texts_[Text::kDanceRemove], PanelControls::Look::kWarning)) {
    removal_.remove(guest.id, now);
    to_be_removed_ = chosen_ = GuestId();
  }
  controls_.flow(controls_.width_of(texts_[Text::kDanceKeep]));
  if (controls_.button("keep", texts_[Text::kDanceKeep])) to_be_removed_ = GuestId();
  // A second Enter removes nobody.
  if (std::exchange(is_removal_asked_, false)) controls_.take_keyboard();
}

// Each dance voice of this house plays the others by itself.
void DancePanel::tell_volume(const SceneState& scene, const GuestId& guest) {
  const float volume = records_.choice_of(guest).heard_volume();
  const std::string command = fmt::format("volume {}={:.2f}", guest.view(), volume);
  voice_trouble_ = scene.voices.empty() ? texts_[Text::kDanceNoVoice] : "";
  if (!needs_.send_voice_command) return;
  for (const SceneVoice& voice : scene.voices)
    if (const auto told = needs_.send_voice_command(voice.guest, command); !told)
      voice_trouble_ = told.error().what;
}

// One that began anew knows nothing of them.
void DancePanel::tell_volumes_anew(const SceneState& scene) {
  const bool is_new = scene.voices.size() > voices_;
  voices_ = scene.voices.size();
  if (!is_new) return;
  for (const auto& [guest, choice] : records_.choices())
    if (choice.heard_volume() != 1.0f) tell_volume(scene, guest);
}

void DancePanel::set_hidden(const GuestId& guest, bool is_hidden) {
  std::erase(needs_.wishes.hidden, guest);
  if (is_hidden && needs_.wishes.hidden.size() < DanceRecords::kMost)
    needs_.wishes.hidden.push_back(guest);
  // Of more than a wish names, poses go on coming.
  DanceBoard::HiddenGuests told{};
  for (std::size_t i = 0; i < std::min(told.size(), needs_.wishes.hidden.size()); ++i)
    told[i] = needs_.wishes.hidden[i];
  needs_.board.hide(told);
}

}  // namespace dance
