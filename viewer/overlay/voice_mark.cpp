#include "viewer/overlay/voice_mark.h"

#include <algorithm>
#include <numbers>

namespace dance {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

struct MarkPen {
  ImDrawList& list;
  ImVec2 centre;
  float size;
  ImU32 ink;
  float line;

  ImVec2 at(float x, float y) const { return {centre.x + x * size, centre.y + y * size}; }
  void arc(float y, float radius, float from_rad, float to_rad) const {
    list.PathArcTo(at(0.0f, y), radius * size, from_rad, to_rad, 16);
    list.PathStroke(ink, 0, line);
  }
  void microphone(bool is_filled) const {
    const ImVec2 low = at(-0.16f, -0.5f), high = at(0.16f, 0.1f);
    if (is_filled)
      list.AddRectFilled(low, high, ink, 0.16f * size);
    else
      list.AddRect(low, high, ink, 0.16f * size, 0, line);
    arc(-0.06f, 0.32f, 0.0f, kPi);
    list.AddLine(at(0.0f, 0.26f), at(0.0f, 0.46f), ink, line);
    list.AddLine(at(-0.18f, 0.46f), at(0.18f, 0.46f), ink, line);
  }
  void headphones() const {
    arc(0.06f, 0.42f, kPi, 2.0f * kPi);
    list.AddRectFilled(at(-0.5f, 0.0f), at(-0.26f, 0.44f), ink, 0.08f * size);
    list.AddRectFilled(at(0.26f, 0.0f), at(0.5f, 0.44f), ink, 0.08f * size);
  }
  void strike() const { list.AddLine(at(-0.46f, -0.46f), at(0.46f, 0.46f), ink, 1.4f * line); }
};

ImU32 ink_of(VoiceMark mark, float alpha) {
  const auto ink = [&](float r, float g, float b, float a) {
    return ImGui::ColorConvertFloat4ToU32(ImVec4(r, g, b, a * alpha));
  };
  if (mark == VoiceMark::kTalking) return ink(0.42f, 0.9f, 0.5f, 1.0f);
  if (mark == VoiceMark::kWaiting) return ink(1.0f, 1.0f, 1.0f, 0.6f);
  if (mark == VoiceMark::kNoMicrophone) return ink(0.75f, 0.75f, 0.75f, 0.9f);
  return ink(1.0f, 0.42f, 0.36f, 1.0f);
}

}  // namespace

void draw_voice_mark(ImDrawList& list, VoiceMark mark, ImVec2 centre, float size_px, float alpha) {
  if (mark == VoiceMark::kNone) return;
  const MarkPen pen{list, centre, size_px, ink_of(mark, alpha), std::max(1.0f, 0.1f * size_px)};
  if (mark == VoiceMark::kDeafened)
    pen.headphones();
  else
    pen.microphone(mark != VoiceMark::kWaiting);
  if (mark != VoiceMark::kWaiting && mark != VoiceMark::kTalking) pen.strike();
}

}  // namespace dance
