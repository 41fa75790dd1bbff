#include "viewer/overlay/beat_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "formats/body/guest_look.h"
#include "viewer/scene/beat_words.h"

namespace dance {
namespace {

constexpr float kPastBeats = 6.4f;
constexpr float kComingBeats = 1.6f;

ImU32 grey(float light, float alpha = 1.0f) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(light, light, light, alpha));
}
ImU32 colour_of_guest(const GuestId& id) {
  const Eigen::Vector3f s = srgb_from_linear(look_of(id).tag);
  return ImGui::ColorConvertFloat4ToU32(ImVec4(s.x(), s.y(), s.z(), 1.0f));
}
ImVec2 whole(float x, float y) { return {std::round(x), std::round(y)}; }

class Panel {
 public:
  Panel(ImDrawList& list, const PanelFonts& fonts, const PanelBox& box)
      : list_(list),
        fonts_(fonts),
        box_(box),
        line_(fonts.text->FontSize),
        left_(box.left + 5.2f * line_),
        right_(box.right - 1.0f * line_) {}

  void draw(const SceneState& scene, const char* title) {
    list_.AddRectFilled({box_.left, box_.top}, {box_.right, box_.bottom},
                        ImGui::ColorConvertFloat4ToU32(ImVec4(0.07f, 0.075f, 0.1f, 1.0f)));
    const float y = box_.top + 0.55f * line_;
    list_.AddText(fonts_.title, fonts_.title->FontSize, whole(box_.left + line_, y), grey(0.97f),
                  title);
    draw_numbers(scene, y + 0.1f * line_);
    if (!scene.music) {
      list_.AddText(fonts_.text, line_, whole(box_.left + line_, box_.top + 3.2f * line_),
                    grey(0.6f), "no music is heard in this house");
      return;
    }
    draw_ruler(*scene.music, scene.guests.size());
    float row = row_y(0);
    for (const SceneGuest& guest : scene.guests) {
      if (row + 0.5f * line_ > box_.bottom) break;
      draw_dancer(guest, *scene.music, row);
      row += 1.55f * line_;
    }
  }

 private:
  float ruler_y() const { return box_.top + 3.6f * line_; }
  float row_y(std::size_t row) const {
    return ruler_y() + (1.2f + 1.55f * static_cast<float>(row)) * line_;
  }
  float x_of(const SceneMusic& music, double beats) const {
    const auto ahead = static_cast<float>(beats - music.beats);
    return left_ + (right_ - left_) * (kPastBeats + ahead) / (kPastBeats + kComingBeats);
  }

  void draw_ruler(const SceneMusic& music, std::size_t rows) {
    const float y = ruler_y();
    const float low = std::min(box_.bottom - 0.3f * line_, row_y(rows) - 0.8f * line_);
    list_.AddText(fonts_.text, line_, whole(box_.left + line_, y - 1.25f * line_), grey(0.6f),
                  "music");
    list_.AddLine({left_, y}, {right_, y}, grey(0.55f), 1.0f);
    // Dancers count two bars of four as eight.
    const int counts = music.beats_per_bar == 4 ? 8 : music.beats_per_bar;
    const double first = std::ceil(music.beats - static_cast<double>(kPastBeats));
    for (double beat = first; beat <= music.beats + static_cast<double>(kComingBeats);
         beat += 1.0) {
      const float x = std::round(x_of(music, beat));
      const double in_bar = counts > 0 ? beat - counts * std::floor(beat / counts) : 1.0;
      const bool is_one = counts > 0 && in_bar == 0.0;
      list_.AddLine({x, y - 0.35f * line_}, {x, low}, grey(is_one ? 0.75f : 0.38f),
                    is_one ? 2.0f : 1.0f);
      if (counts <= 0) continue;
      std::array<char, 12> count{};
      std::snprintf(count.data(), count.size(), "%d", static_cast<int>(in_bar) + 1);
      const float width = fonts_.text->CalcTextSizeA(line_, 1e4f, 0.0f, count.data()).x;
      list_.AddText(fonts_.text, line_, whole(x - 0.5f * width, y - 1.4f * line_),
                    grey(is_one ? 0.97f : 0.7f), count.data());
    }
    const float now = std::round(x_of(music, music.beats));
    list_.AddRectFilled({now - 1.0f, y - 0.5f * line_}, {now + 1.0f, low},
                        ImGui::ColorConvertFloat4ToU32(ImVec4(1.0f, 0.78f, 0.25f, 0.9f)));
  }

  void draw_dancer(const SceneGuest& guest, const SceneMusic& music, float y) {
    const ImU32 colour = colour_of_guest(guest.id);
    list_.PushClipRect({box_.left, box_.top}, {left_ - 0.4f * line_, box_.bottom}, true);
    list_.AddText(fonts_.text, line_, whole(box_.left + line_, y - 0.55f * line_), grey(0.9f),
                  guest.id.c_str());
    list_.PopClipRect();
    if (!guest.figures.beat) return;
    const BeatFigures& beat = *guest.figures.beat;
    list_.PushClipRect({left_ - 0.35f * line_, box_.top}, {right_, box_.bottom}, true);
    for (std::size_t i = 0; i < beat.own_beat_count; ++i) {
      const float x = x_of(music, beat.own_beats[i]);
      if (guest.is_predicted)
        list_.AddCircle({x, y}, 0.3f * line_, colour, 20, 2.0f);
      else
        list_.AddCircleFilled({x, y}, 0.32f * line_, colour, 20);
    }
    list_.PopClipRect();
  }

  // A prediction is on the beat by construction, which says nothing of how good it is.
  void draw_numbers(const SceneState& scene, float y) {
    const auto compared =
        std::find_if(scene.guests.begin(), scene.guests.end(), [](const SceneGuest& guest) {
          return guest.is_compared && guest.figures.beat && guest.figures.beat->delay_ms;
        });
    if (compared == scene.guests.end()) return;
    const BeatFigures& beat = *compared->figures.beat;
    const auto age_ms = static_cast<double>(*beat.delay_ms);
    std::string text = std::string(compared->id.view()) + ": ";
    text += compared->is_predicted ? prediction_words(age_ms)
                                   : fmt::format("{}, \u00b1 {:.0f} ms; {:.0f} ms old",
                                                 beat_words(static_cast<double>(beat.behind_ms)),
                                                 beat.wander_ms, age_ms);
    const float width = fonts_.text->CalcTextSizeA(line_, 1e4f, 0.0f, text.c_str()).x;
    list_.AddText(fonts_.text, line_, whole(box_.right - line_ - width, y), grey(0.85f),
                  text.c_str());
  }

  ImDrawList& list_;
  const PanelFonts& fonts_;
  const PanelBox& box_;
  float line_;
  float left_, right_;
};

}  // namespace

void draw_beat_panel(ImDrawList& list, const PanelFonts& fonts, const SceneState& scene,
                     const PanelBox& box, const char* title) {
  Panel(list, fonts, box).draw(scene, title);
}

}  // namespace dance
