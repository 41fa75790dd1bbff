#include "viewer/style_panel/style_sliders.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "transformers/style/body_zones.h"
#include "transformers/style/style_presets.h"

namespace dance {
namespace {

// Names on the left, sliders in one column.
constexpr float kNames_em = 6.6f;
constexpr float kReset_em = 3.6f;

struct Range {
  float low, high, usual;
  const char* format;
};

bool begin_row(const char* name, float em) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(name);
  ImGui::SameLine(kNames_em * em);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - kReset_em * em);
  return true;
}

// Where the value is not as usual, the way back.
bool reset_button(const char* name, bool is_usual) {
  if (is_usual) return false;
  ImGui::SameLine();
  ImGui::PushID(name);
  const bool is_pressed = ImGui::SmallButton("reset");
  ImGui::PopID();
  return is_pressed;
}

bool slider(const char* name, float& value, const Range& range, float em) {
  begin_row(name, em);
  const std::string id = std::string("##") + name;
  bool is_changed = ImGui::SliderFloat(id.c_str(), &value, range.low, range.high, range.format,
                                       ImGuiSliderFlags_AlwaysClamp);
  const bool is_usual = std::abs(value - range.usual) < 0.005f;
  if (reset_button(name, is_usual)) {
    value = range.usual;
    is_changed = true;
  }
  return is_changed;
}

bool whole_slider(const char* name, float& value, int low, int high, int usual, const char* format,
                  float em) {
  begin_row(name, em);
  int whole = static_cast<int>(std::lround(value));
  const std::string id = std::string("##") + name;
  bool is_changed =
      ImGui::SliderInt(id.c_str(), &whole, low, high, format, ImGuiSliderFlags_AlwaysClamp);
  if (reset_button(name, whole == usual)) {
    whole = usual;
    is_changed = true;
  }
  if (is_changed) value = static_cast<float>(whole);
  return is_changed;
}

// The switch of a word; false where its settings are not to be shown.
bool word_switch(FlowSetting& setting, FlowWord word, bool& is_changed) {
  const std::size_t place = index_of(word);
  if (!setting.has[place]) return false;
  bool is_on = setting.on[place];
  if (ImGui::Checkbox(kFlowWordNames[place].data(), &is_on)) {
    setting.on[place] = is_on;
    is_changed = true;
  }
  return true;
}

void scale_gains(Style& style, float by) {
  for (float& gain : style.gain)
    gain = std::clamp(1.0f + (gain - 1.0f) + by, 0.0f, static_cast<float>(kMostSpokenGain));
}

bool presets(Style& style, float em) {
  bool is_changed = false;
  const float right = ImGui::GetWindowContentRegionMax().x;
  bool is_first = true;
  const auto button = [&](const char* words) {
    const float width = ImGui::CalcTextSize(words).x + 2.0f * ImGui::GetStyle().FramePadding.x;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    if (!is_first) {
      ImGui::SameLine();
      if (ImGui::GetCursorPosX() + width > right + 0.5f * gap) ImGui::NewLine();
    }
    is_first = false;
    return ImGui::Button(words);
  };
  for (const std::string_view name : style_preset_list()) {
    std::string words(name);
    std::replace(words.begin(), words.end(), '-', ' ');
    if (!button(words.c_str())) continue;
    style.gain = find_style_preset(name)->gain;
    is_changed = true;
  }
  if (button("smaller")) {
    scale_gains(style, -0.1f);
    is_changed = true;
  }
  if (button("larger")) {
    scale_gains(style, 0.1f);
    is_changed = true;
  }
  ImGui::Dummy({0.0f, 0.2f * em});
  return is_changed;
}

}  // namespace

bool edit_transformers(FlowSetting& setting, float em) {
  bool is_changed = false;
  if (word_switch(setting, FlowWord::kHold, is_changed)) {
    const char* words = setting.hold_ms < 0.0f ? "as needed" : "%.0f ms";
    is_changed |= slider("  window", setting.hold_ms, {-1.0f, 500.0f, -1.0f, words}, em);
  }
  if (word_switch(setting, FlowWord::kPredict, is_changed)) {
    is_changed |= slider("  lead", setting.lead, {0.0f, 1.5f, 1.0f, "%.2f"}, em);
    is_changed |= slider("  furthest", setting.reach_ms, {0.0f, 1000.0f, 300.0f, "%.0f ms"}, em);
  }
  (void)word_switch(setting, FlowWord::kBridge, is_changed);
  if (word_switch(setting, FlowWord::kRhythm, is_changed)) {
    is_changed |= slider("  strength", setting.rhythm_strength, {0.0f, 1.0f, 1.0f, "%.2f"}, em);
    const char* words = setting.rhythm_beats < 0.0f ? "auto" : "%d behind";
    is_changed |= whole_slider("  beats", setting.rhythm_beats, -1, 8, -1, words, em);
    is_changed |= whole_slider("  in steps of", setting.rhythm_count, 1, 8, 1, "%d", em);
    if (setting.rhythm_beats < 0.0f)
      is_changed |=
          slider("  error", setting.rhythm_error_mm, {10.0f, 200.0f, 60.0f, "%.0f mm"}, em);
  }
  (void)word_switch(setting, FlowWord::kStylize, is_changed);
  return is_changed;
}

bool edit_zones(Style& style, float usual_dynamic, float em) {
  bool is_changed = presets(style, em);
  for (std::size_t zone = 0; zone < kBodyZones; ++zone)
    is_changed |= slider(std::string(kZoneNames[zone]).c_str(), style.gain[zone],
                         {0.0f, static_cast<float>(kMostSpokenGain), 1.0f, "%.2f"}, em);
  is_changed |= slider("with the bar", style.periodic, {0.0f, 1.0f, 1.0f, "%.2f"}, em);
  is_changed |= slider("the rest", style.dynamic, {0.0f, 1.0f, usual_dynamic, "%.2f"}, em);
  return is_changed;
}

}  // namespace dance
