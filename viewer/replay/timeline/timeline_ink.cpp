#include "viewer/replay/timeline/timeline_ink.h"

#include <numbers>

namespace dance {

bool TimelinePanel::Ink::button(const char* name, ImVec2 at, Icon icon, bool is_on) const {
  const float size = 1.8f * em();
  ImGui::SetCursorScreenPos(at);
  const bool is_pressed = ImGui::InvisibleButton(name, {size, size});
  const bool is_over = ImGui::IsItemHovered();
  if (is_on) list().AddRectFilled(at, {at.x + size, at.y + size}, kChosen, 0.3f * em());
  if (is_over) list().AddRectFilled(at, {at.x + size, at.y + size}, kFaint, 0.3f * em());
  sign(icon, {at.x + 0.5f * size, at.y + 0.5f * size}, is_over || is_on ? kBright : kDim);
  return is_pressed;
}

void TimelinePanel::Ink::sign(Icon icon, ImVec2 c, ImU32 colour) const {
  const float u = 0.5f * em();
  const float thin = std::max(1.0f, 0.13f * em());
  const auto triangle = [&](float x, float direction, float size) {
    list().AddTriangleFilled({c.x + x - direction * size * u, c.y - size * u},
                             {c.x + x - direction * size * u, c.y + size * u},
                             {c.x + x + direction * size * u, c.y}, colour);
  };
  const auto upright = [&](float x, float half_height) {
    list().AddRectFilled({c.x + x - 0.5f * thin, c.y - half_height},
                         {c.x + x + 0.5f * thin, c.y + half_height}, colour);
  };
  const auto level = [&](float y, float from, float to) {
    list().AddRectFilled({c.x + from, c.y + y - 0.5f * thin}, {c.x + to, c.y + y + 0.5f * thin},
                         colour);
  };
  switch (icon) {
    case Icon::kStart:
      upright(-u, 0.9f * u);
      return triangle(0.2f * u, -1.0f, 0.8f);
    case Icon::kBack:
      triangle(-0.6f * u, -1.0f, 0.65f);
      return triangle(0.6f * u, -1.0f, 0.65f);
    case Icon::kOn:
      triangle(-0.6f * u, 1.0f, 0.65f);
      return triangle(0.6f * u, 1.0f, 0.65f);
    case Icon::kFrameBack:
      triangle(-0.3f * u, -1.0f, 0.65f);
      return upright(0.8f * u, 0.65f * u);
    case Icon::kFrameOn:
      upright(-0.8f * u, 0.65f * u);
      return triangle(0.3f * u, 1.0f, 0.65f);
    case Icon::kPlay:
      return triangle(0.1f * u, 1.0f, 1.05f);
    case Icon::kPause:
      for (const float x : {-0.5f, 0.5f})
        list().AddRectFilled({c.x + (x - 0.26f) * u, c.y - u}, {c.x + (x + 0.26f) * u, c.y + u},
                             colour);
      return;
    case Icon::kLoopBegin:
    case Icon::kLoopEnd: {
      const float side = icon == Icon::kLoopBegin ? -1.0f : 1.0f;
      upright(0.4f * side * u, u);
      for (const float y : {-1.0f, 1.0f})
        level(y * (u - 0.5f * thin), std::min(0.4f * side * u, -0.4f * side * u),
              std::max(0.4f * side * u, -0.4f * side * u));
      return;
    }
    case Icon::kLoop: {
      constexpr float kPi = std::numbers::pi_v<float>;
      list().PathArcTo(c, 0.85f * u, -0.25f * kPi, 1.35f * kPi, 20);
      list().PathStroke(colour, ImDrawFlags_None, thin);
      const ImVec2 tip{c.x + 0.6f * u, c.y - 0.6f * u};
      list().AddTriangleFilled({tip.x - 0.62f * u, tip.y - 0.2f * u},
                               {tip.x + 0.25f * u, tip.y - 0.5f * u},
                               {tip.x + 0.2f * u, tip.y + 0.5f * u}, colour);
      return;
    }
    case Icon::kMinus:
      return level(0.0f, -0.6f * u, 0.6f * u);
    case Icon::kPlus:
      level(0.0f, -0.6f * u, 0.6f * u);
      return upright(0.0f, 0.6f * u);
    case Icon::kExport:
      upright(0.0f, 0.55f * u);
      list().AddTriangleFilled({c.x - 0.5f * u, c.y - 0.45f * u}, {c.x + 0.5f * u, c.y - 0.45f * u},
                               {c.x, c.y - 1.1f * u}, colour);
      level(u, -0.9f * u, 0.9f * u);
      for (const float x : {-0.9f, 0.9f})
        list().AddRectFilled({c.x + x * u - 0.5f * thin, c.y + 0.4f * u},
                             {c.x + x * u + 0.5f * thin, c.y + u}, colour);
      return;
  }
}

}  // namespace dance
