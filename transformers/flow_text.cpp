#include "transformers/flow_text.h"

#include <algorithm>
#include <cmath>

#include "core/base/plain_number.h"
#include "transformers/flow.h"
#include "transformers/style/body_zones.h"
#include "transformers/style/style_presets.h"

namespace dance {
namespace {

// A setting counts as changed from here on.
constexpr float kSame = 0.005f;

bool is_same(float a, float b) { return std::abs(a - b) < kSame; }
double rounded(float value) { return std::round(static_cast<double>(value) * 100.0) / 100.0; }

void append(std::string& text, std::string_view name, float value, float usual,
            std::string_view unit = "") {
  if (is_same(value, usual)) return;
  text += " " + std::string(name) + "=" + plain_number(rounded(value)) + std::string(unit);
}

// The settings of one word alone.
bool says(std::string_view old, FlowWord word, const FlowSetting& wanted) {
  const auto flow = Flow::make({std::string(old)});
  if (!flow || !flow->setting().has_word(word)) return false;
  const FlowSetting& is = flow->setting();
  if (is.on[index_of(word)] != wanted.on[index_of(word)]) return false;
  switch (word) {
    case FlowWord::kHold:
      return is_same(is.hold_ms, wanted.hold_ms) || (is.hold_ms < 0.0f && wanted.hold_ms < 0.0f);
    case FlowWord::kPredict:
      return is_same(is.lead, wanted.lead) && is_same(is.reach_ms, wanted.reach_ms);
    case FlowWord::kBridge:
      return true;
    case FlowWord::kRhythm:
      return is_same(is.rhythm_beats, wanted.rhythm_beats) &&
             is_same(is.rhythm_count, wanted.rhythm_count) &&
             is_same(is.rhythm_strength, wanted.rhythm_strength) &&
             is_same(is.rhythm_error_mm, wanted.rhythm_error_mm);
    case FlowWord::kStylize:
      return std::equal(is.gain.begin(), is.gain.end(), wanted.gain.begin(), is_same) &&
             is_same(is.periodic, wanted.periodic) && is_same(is.dynamic, wanted.dynamic);
  }
  return false;
}

// What no setting of a flow has: "blend=30ms".
std::string kept_argument(std::string_view old, std::string_view name) {
  const std::size_t begin = old.find(" " + std::string(name) + "=");
  if (begin == std::string_view::npos) return "";
  return std::string(old.substr(begin, old.find(' ', begin + 1) - begin));
}

std::string gains_text(const std::array<float, kBodyZones>& gain) {
  std::string text;
  for (std::size_t zone = 0; zone < kBodyZones; ++zone)
    append(text, kZoneNames[zone], gain[zone], 1.0f);
  return text;
}

}  // namespace

std::string style_text(const Style& style, double usual_mix) {
  std::string text;
  for (const std::string_view name : style_preset_list()) {
    const auto preset = find_style_preset(name);
    if (std::equal(preset->gain.begin(), preset->gain.end(), style.gain.begin(), is_same))
      text = " preset=" + std::string(name);
  }
  if (text.empty()) text = gains_text(style.gain);
  append(text, "mix", style.dynamic, static_cast<float>(usual_mix));
  append(text, "bar", style.periodic, 1.0f);
  return text.substr(1);
}

std::string word_text(FlowWord word, const FlowSetting& setting, std::string_view old) {
  if (!old.empty() && says(old, word, setting)) return std::string(old);
  std::string text(kFlowWordNames[index_of(word)]);
  switch (word) {
    case FlowWord::kHold:
      if (setting.hold_ms >= 0.0f) text += " " + plain_number(rounded(setting.hold_ms)) + "ms";
      break;
    case FlowWord::kPredict:
      append(text, "lead", setting.lead, 1.0f);
      append(text, "most", setting.reach_ms, 300.0f, "ms");
      text += kept_argument(old, "partner");
      break;
    case FlowWord::kBridge:
      text += kept_argument(old, "blend");
      break;
    case FlowWord::kRhythm:
      if (setting.rhythm_beats >= 0.0f) append(text, "beats", setting.rhythm_beats, -1.0f);
      append(text, "count", setting.rhythm_count, 1.0f);
      append(text, "strength", setting.rhythm_strength, 1.0f);
      append(text, "error", setting.rhythm_error_mm, 60.0f);
      break;
    case FlowWord::kStylize: {
      Style style;
      style.gain = setting.gain;
      style.periodic = setting.periodic;
      style.dynamic = setting.dynamic;
      const std::string words = style_text(style, kUsualMix);
      if (words != "preset=as-danced") text += " " + words;
      break;
    }
  }
  if (!setting.on[index_of(word)]) text += " on=0";
  return text;
}

}  // namespace dance
