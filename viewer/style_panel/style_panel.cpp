#include "viewer/style_panel/style_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "transformers/flow_text.h"
#include "transformers/style/style_presets.h"
#include "viewer/style_panel/style_sliders.h"

namespace dance {
namespace {

constexpr std::array<KeyHelp, 2> kKeys{{{"S", Text::kDoStyle}, {"Tab", Text::kDoNextGuest}}};
constexpr float kWidth_em = 25.0f;
constexpr double kOwnMix = 1.0;  // as `dance style` has it

Style base_of(const FlowSetting& setting) {
  Style style;
  style.gain = setting.gain;
  style.periodic = setting.periodic;
  style.dynamic = setting.dynamic;
  return style;
}

Style guest_style_of(const FlowSetting& setting) {
  Style style;
  style.gain = setting.guest_gain;
  style.periodic = setting.guest_periodic;
  style.dynamic = setting.guest_dynamic;
  return style;
}

bool is_as_danced(const Style& style) {
  return std::all_of(style.gain.begin(), style.gain.end(),
                     [](float gain) { return std::abs(gain - 1.0f) < 0.005f; });
}

// Of words that cannot be read: as danced.
Style style_in_words(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return read_style("style", words, kOwnMix).value_or(Style());
}

// Two decimals are written.
bool is_alike(const Style& a, const Style& b) {
  const auto is_near = [](float x, float y) { return std::abs(x - y) < 0.005f; };
  return std::equal(a.gain.begin(), a.gain.end(), b.gain.begin(), is_near) &&
         is_near(a.periodic, b.periodic) && is_near(a.dynamic, b.dynamic);
}

void set_colours(float em) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.9f * em, 0.7f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.45f * em, 0.12f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.5f * em, 0.22f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 0.7f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.2f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, IM_COL32(52, 60, 78, 255));
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, IM_COL32(111, 183, 255, 255));
  ImGui::PushStyleColor(ImGuiCol_CheckMark, IM_COL32(111, 183, 255, 255));
  ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(61, 111, 181, 255));
  ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(244, 245, 249, 255));
}
constexpr int kStyleVars = 7, kStyleColours = 5;

}  // namespace

bool is_same_style(const Style& a, const Style& b) {
  const auto is_same = [](float x, float y) { return std::abs(x - y) < 1e-4f; };
  return std::equal(a.gain.begin(), a.gain.end(), b.gain.begin(), is_same) &&
         is_same(a.periodic, b.periodic) && is_same(a.dynamic, b.dynamic);
}

std::span<const KeyHelp> StylePanel::keys() const { return kKeys; }

const GuestRecord* StylePanel::chosen() const {
  if (const GuestRecord* record = records_.find(chosen_)) return record;
  return records_.guests().empty() ? nullptr : &records_.guests().front();
}

void StylePanel::choose_next(std::size_t step) {
  const auto& guests = records_.guests();
  if (guests.empty()) return;
  const auto place = static_cast<std::size_t>(chosen() - guests.data());
  chosen_ = guests[(place + step) % guests.size()].guest();
}

bool StylePanel::on_key(const KeyPress& press) {
  const bool closes = is_open_ && press.key == GLFW_KEY_ESCAPE;
  if (closes || (press.key == GLFW_KEY_S && !press.has_control && !press.is_repeat)) {
    is_open_ = !is_open_;
    return true;
  }
  if (!is_open_ || press.key != GLFW_KEY_TAB) return false;
  choose_next(press.has_shift ? records_.guests().size() - 1 : 1);
  return true;
}

void StylePanel::follow(MonoTime now) {
  const GuestRecord* record = chosen();
  if (record == nullptr) return;
  if (record->guest() != followed_) {
    flow_.reset();
    own_.reset();
    note_.clear();
    followed_ = record->guest();
  }
  if (!record->flow) return;
  if (flow_.follow(*record->flow, now) && is_live_) {
    FlowSetting setting = flow_.setting();
    setting.time = now;
    setting.clock_id = record->flow->clock_id;
    board_.ask(record->guest(), setting);
  }
  if (own_.follow(guest_style_of(*record->flow), now) && is_live_) {
    Style style = own_.setting();
    style.time = now;
    style.clock_id = record->flow->clock_id;
    board_.ask(record->guest(), style);
  }
  if (!flow_.is_unheard() && !own_.is_unheard()) return;
  note_ = "nobody takes it: is the house open? dance join or dance manager";
  is_note_error_ = true;
}

void StylePanel::save() {
  const GuestRecord* record = chosen();
  if (file_ == nullptr || record == nullptr || !record->flow) return;
  const FlowSetting& in_force = *record->flow;
  SessionEdit edit;
  edit.route = static_cast<std::size_t>(std::max(in_force.route, 0));
  const std::vector<std::string> old = file_->words(edit.route);
  for (std::size_t word = 0; word < kFlowWords; ++word) {
    if (!in_force.has[word]) continue;
    std::string was;
    for (const std::string& text : old)
      if (text == kFlowWordNames[word] || text.starts_with(std::string(kFlowWordNames[word]) + " "))
        was = text;
    edit.words.push_back(
        {std::string(kFlowWordNames[word]), word_text(static_cast<FlowWord>(word), in_force, was)});
  }
  // The file keeps its own words where they say what is in force, and says nothing of a guest who
  // dances as they do without it.
  const std::string guest(record->guest().view());
  const Style own = guest_style_of(in_force);
  if (in_force.own && !is_alike(own, style_in_words(file_->style(guest).value_or(""))))
    edit.style = StyleEdit{guest, style_text(own, kOwnMix)};
  const auto saved = file_->save(edit);
  is_note_error_ = !saved;
  note_ = saved ? "saved in " + file_->path() +
                      (in_force.own ? "" : ": from the next start for all guests of this route")
                : saved.error().what;
}

void StylePanel::draw_guest(const PanelFrame& frame) {
  const GuestRecord* record = chosen();
  ImGui::PushFont(frame.large_font);
  ImGui::TextUnformatted(record ? std::string(record->guest().view()).c_str() : "nobody is here");
  ImGui::PopFont();
  if (records_.guests().size() < 2) return;
  const float width = ImGui::CalcTextSize("next").x + 2.0f * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
  if (ImGui::Button("next")) choose_next(1);
}

void StylePanel::draw_content(const PanelFrame& frame, const GuestRecord& record) {
  const float em = frame.small_font->FontSize;
  const FlowSetting& in_force = *record.flow;
  if (!is_live_) ImGui::BeginDisabled();
  FlowSetting setting = flow_.setting();
  const bool has_words =
      std::any_of(setting.has.begin(), setting.has.end(), [](bool b) { return b; });
  if (!has_words) ImGui::TextDisabled("shown as captured: no transformers in this route");
  bool is_changed = has_words && edit_transformers(setting, em);
  ImGui::Separator();
  if (setting.has_word(FlowWord::kStylize)) {
    ImGui::TextDisabled("how large, on this stage");
    Style style = base_of(setting);
    if (edit_zones(style, kUsualDynamic, em)) {
      setting.gain = style.gain;
      setting.periodic = style.periodic;
      setting.dynamic = style.dynamic;
      is_changed = true;
    }
    const Style guest = guest_style_of(in_force);
    if (!is_as_danced(guest))
      ImGui::TextWrapped("times what the guest asks for: %s", style_text(guest, kOwnMix).c_str());
  } else if (in_force.own) {
    ImGui::TextDisabled("how large, in the other houses");
    Style style = own_.setting();
    if (edit_zones(style, static_cast<float>(kOwnMix), em)) change(style, frame.scene.time);
  }
  if (is_changed) flow_.change(setting, frame.scene.time);
  if (!is_live_) ImGui::EndDisabled();
}

void StylePanel::draw_footer() {
  ImGui::Separator();
  if (!is_live_) {
    ImGui::TextDisabled("a recording: as it was");
    return;
  }
  if (file_ == nullptr) {
    ImGui::TextDisabled("to save, start with --session FILE");
  } else if (ImGui::Button("save in the session file")) {
    save();
  }
  if (note_.empty()) return;
  ImGui::PushStyleColor(
      ImGuiCol_Text, is_note_error_ ? IM_COL32(255, 180, 84, 255) : IM_COL32(167, 173, 189, 255));
  ImGui::TextWrapped("%s", note_.c_str());
  ImGui::PopStyleColor();
}

void StylePanel::draw(const PanelFrame& frame) {
  if (!is_open_ || frame.small_font == nullptr) return;
  follow(frame.scene.time);
  const float em = frame.small_font->FontSize, margin = 0.7f * em;
  const float width = std::min(kWidth_em * em, frame.width_px - 2.0f * margin);
  const float most = frame.height_px - 2.0f * margin;
  ImGui::PushFont(frame.small_font);
  set_colours(em);
  ImGui::SetNextWindowPos({frame.width_px - margin - width, margin});
  ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {width, most});
  ImGui::SetNextWindowSize(
      {width, std::min(most, last_height_px_ > 0.0f ? last_height_px_ : most)});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoBackground;
  if (ImGui::Begin("style", nullptr, kFlags)) {
    // The paper lies under the content, which says how high it is.
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.ChannelsSplit(2);
    list.ChannelsSetCurrent(1);
    draw_guest(frame);
    const GuestRecord* record = chosen();
    if (record != nullptr && record->flow) {
      draw_content(frame, *record);
      draw_footer();
    } else {
      ImGui::TextWrapped("the house has not told how this guest is shown: no manager runs here");
    }
    // The mouse is the panel's as high as its content, from the next picture on.
    last_height_px_ = std::min(most, ImGui::GetCursorPosY() + 0.5f * em);
    list.ChannelsSetCurrent(0);
    const ImVec2 low = ImGui::GetWindowPos();
    list.PushClipRectFullScreen();
    list.AddRectFilled(low, {low.x + width, low.y + last_height_px_}, IM_COL32(13, 16, 24, 251),
                       0.5f * em);
    list.PopClipRect();
    list.ChannelsMerge();
  }
  ImGui::End();
  ImGui::PopStyleColor(kStyleColours);
  ImGui::PopStyleVar(kStyleVars);
  ImGui::PopFont();
}

}  // namespace dance
