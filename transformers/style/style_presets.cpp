#include "transformers/style/style_presets.h"

#include "transformers/settings.h"
#include "transformers/style/body_zones.h"

namespace dance {
namespace {

struct Preset {
  std::string_view name;
  std::array<float, kBodyZones> gain;  // hips, torso, shoulders, arms, hands, legs, head
};

constexpr std::array<Preset, 5> kPresets{{
    {"as-danced", {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}},
    {"subtle", {1.15f, 1.1f, 1.1f, 1.1f, 1.1f, 1.0f, 1.0f}},
    // Son and rumba: hips and ribs speak, arms stay close, the head stays level.
    {"cuban", {1.6f, 1.3f, 1.35f, 0.9f, 1.0f, 1.0f, 0.8f}},
    {"big", {1.5f, 1.3f, 1.4f, 1.4f, 1.3f, 1.1f, 1.1f}},
    {"calm", {0.7f, 0.75f, 0.7f, 0.65f, 0.7f, 1.0f, 0.7f}},
}};

}  // namespace

std::optional<Style> find_style_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    Style style;
    style.gain = preset.gain;
    return style;
  }
  return std::nullopt;
}

std::span<const std::string_view> style_preset_list() {
  static constexpr auto kNames = [] {
    std::array<std::string_view, kPresets.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPresets[i].name;
    return names;
  }();
  return kNames;
}

std::string style_preset_names() {
  std::string names;
  for (const Preset& preset : kPresets)
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  return names;
}

Result<Style> read_style(std::string_view who, std::span<const std::string_view> words,
                         double usual_mix) {
  Settings settings(who, words);
  std::string preset = "as-danced";
  settings.text("preset", preset);
  const auto named = find_style_preset(preset);
  if (!named)
    return fail(std::string(who) + " has no preset '" + preset +
                "'; there are: " + style_preset_names());
  Style style = *named;
  for (std::size_t z = 0; z < kBodyZones; ++z) {
    double gain = static_cast<double>(style.gain[z]);
    settings.number(kZoneNames[z], gain, 0.0, kMostSpokenGain);
    style.gain[z] = static_cast<float>(gain);
  }
  double mix = usual_mix;
  double periodic = 1.0;
  settings.number("mix", mix, 0.0, 1.0).number("bar", periodic, 0.0, 1.0);
  style.periodic = static_cast<float>(periodic);
  style.dynamic = static_cast<float>(mix);
  if (auto done = settings.done(); !done) return tl::make_unexpected(done.error());
  return style;
}

}  // namespace dance
