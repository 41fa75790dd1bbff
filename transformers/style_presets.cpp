#include "transformers/style_presets.h"

namespace dance {
namespace {

struct Preset {
  std::string_view name;
  std::array<float, kBodyZones> gain;  // hips, torso, shoulders, arms, hands, legs, head
  float periodic;
  float dynamic;
};

constexpr std::array<Preset, 5> kPresets{{
    {"as-danced", {1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f}, 1.0f, 1.0f},
    {"subtle", {1.15f, 1.1f, 1.1f, 1.1f, 1.1f, 1.0f, 1.0f}, 1.0f, 1.0f},
    // Son and rumba: hips and ribs speak, arms stay close, the head stays level.
    {"cuban", {1.6f, 1.3f, 1.35f, 0.9f, 1.0f, 1.0f, 0.8f}, 1.0f, 0.6f},
    {"big", {1.4f, 1.25f, 1.4f, 1.35f, 1.3f, 1.1f, 1.1f}, 1.0f, 1.0f},
    {"calm", {0.7f, 0.75f, 0.7f, 0.65f, 0.7f, 1.0f, 0.7f}, 1.0f, 1.0f},
}};

}  // namespace

std::optional<Style> find_style_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    Style style;
    style.gain = preset.gain;
    style.periodic = preset.periodic;
    style.dynamic = preset.dynamic;
    return style;
  }
  return std::nullopt;
}

std::string style_preset_names() {
  std::string names;
  for (const Preset& preset : kPresets)
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  return names;
}

}  // namespace dance
