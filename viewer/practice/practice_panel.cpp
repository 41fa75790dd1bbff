#include "viewer/practice/practice_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "viewer/panel/panel_colours.h"

namespace dance {
namespace {

// The second with a teacher.
constexpr std::array<KeyHelp, 2> kPracticeKeys{
    {{"E", Text::kDoPractice}, {", .", Text::kDoTeacherSpeed}}};
constexpr ImU32 kButton = IM_COL32(52, 60, 78, 255);
constexpr ImU32 kButtonOn = IM_COL32(61, 111, 181, 255);
constexpr ImU32 kNotYet = IM_COL32(255, 255, 255, 60);
// A smaller mean is within what a camera and a loudspeaker are late by themselves.
constexpr float kTold_ms = 40.0f;
constexpr int kFewestForLateness = 5;

float width_of(ImFont& font, const std::string& words) {
  return font.CalcTextSizeA(font.FontSize, 1e5f, 0.0f, words.c_str()).x;
}

// Filled, or an empty ring, as colours alone are not told apart by all.
void draw_dots(ImDrawList& list, const StepScore::Figures& figures, ImVec2 left, float em) {
  const float step = 1.15f * em, radius = 0.36f * em;
  for (int i = 0; i < StepScore::kBeats; ++i) {
    const ImVec2 centre{left.x + radius + step * static_cast<float>(i), left.y};
    const int beat = i - (StepScore::kBeats - figures.counted);
    if (beat < 0)
      list.AddCircleFilled(centre, 0.3f * radius, kNotYet, 12);
    else if (figures.met[static_cast<std::size_t>(beat)])
      list.AddCircleFilled(centre, radius, panel_colours::kGood, 20);
    else
      list.AddCircle(centre, radius, panel_colours::kQuiet, 20, std::max(1.0f, 0.12f * em));
  }
}

}  // namespace

std::string lateness_words(const StepScore::Figures& figures, const Texts& texts) {
  if (figures.counted < kFewestForLateness || std::abs(figures.late_ms) < kTold_ms) return "";
  const auto tens_ms = static_cast<int>(std::lround(0.1f * std::abs(figures.late_ms)) * 10);
  return texts.say(figures.late_ms > 0.0f ? Text::kPracticeLate : Text::kPracticeEarly,
                   {std::to_string(tens_ms)});
}

std::span<const KeyHelp> PracticePanel::keys() const {
  return std::span(kPracticeKeys).first(needs_.teacher != nullptr ? 2 : 1);
}

bool PracticePanel::on_key(const KeyPress& press) {
  if (press.has_control) return false;
  if (is_open_ && needs_.teacher != nullptr &&
      (press.key == GLFW_KEY_COMMA || press.key == GLFW_KEY_PERIOD)) {
    needs_.teacher->speed =
        changed_speed(needs_.teacher->speed, press.key == GLFW_KEY_COMMA ? -1 : 1);
    return true;
  }
  if (press.key != GLFW_KEY_E || press.is_repeat) return false;
  is_open_ = !is_open_;
  return true;
}

void PracticePanel::draw(const PanelFrame& frame) {
  if (!is_open_ || frame.large_font == nullptr) return;
  const Texts texts(frame.language);
  const auto score = needs_.score(frame.scene.time);
  const StepScore::Figures figures = score.value_or(StepScore::Figures());
  const bool counts = frame.scene.music && figures.counted > 0;
  std::string words = texts[frame.scene.music ? Text::kPracticeNoSteps : Text::kPracticeNoMusic];
  if (counts)
    words = texts.say(Text::kPracticeOnTheBeat,
                      {std::to_string(figures.met_count()), std::to_string(figures.counted)});
  const std::string late = counts ? lateness_words(figures, texts) : "";
  ImFont& large = *frame.large_font;
  ImFont& small = *frame.small_font;
  const float em = large.FontSize, pad = 0.6f * em;
  const float dots = counts ? 1.15f * em * static_cast<float>(StepScore::kBeats) + 0.4f * em : 0.0f;
  ImFont& font = counts ? large : small;
  const float width = 2.0f * pad + std::max(dots + width_of(font, words), width_of(small, late));
  const float height = 2.0f * pad + font.FontSize + (late.empty() ? 0.0f : 1.4f * small.FontSize);
  const float left = std::round(0.7f * em + frame.figures_px);
  float top = std::round(0.7f * em);
  if (needs_.teacher != nullptr) top = draw_teacher(frame, left, top) + std::round(0.4f * em);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({left, top}, {left + width, top + height}, panel_colours::kBackground,
                     0.5f * em);
  if (counts) draw_dots(list, figures, {left + pad, top + pad + 0.5f * em}, em);
  list.AddText(&font, font.FontSize, {std::round(left + pad + dots), top + pad},
               counts ? panel_colours::kText : panel_colours::kQuiet, words.c_str());
  list.AddText(&small, small.FontSize, {left + pad, std::round(top + pad + 1.25f * em)},
               panel_colours::kQuiet, late.c_str());
}

// A row of buttons; its size is known before it is drawn, so that the first picture has it too.
float PracticePanel::draw_teacher(const PanelFrame& frame, float left_px, float top_px) {
  const Texts texts(frame.language);
  TeacherChoices& choices = *needs_.teacher;
  ImFont& font = *frame.small_font;
  const float em = font.FontSize, pad = 0.6f * em, gap = 0.5f * em;
  const std::string note = needs_.teacher_note ? needs_.teacher_note() : "";
  const std::string name = note.empty() ? texts[Text::kNameTeacher] : note;
  const std::string speed = std::to_string(std::lround(100.0 * choices.speed)) + " %";
  const float sign = 1.8f * em, percent = width_of(font, "100 %");
  const auto button_width = [&](Text words) { return width_of(font, texts[words]) + 1.2f * em; };
  const float mirror = button_width(Text::kTeacherMirror), over = button_width(Text::kTeacherOver);
  float width = 2.0f * pad + width_of(font, name);
  if (note.empty()) width += 2.0f * sign + percent + mirror + over + 5.0f * gap;
  const float height = 1.6f * em + 2.0f * pad;
  ImGui::SetNextWindowPos({left_px, top_px});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {pad, pad});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.6f * em, 0.3f * em});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.25f * em);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, panel_colours::kBackground);
  ImGui::PushStyleColor(ImGuiCol_Text, panel_colours::kText);
  ImGui::PushFont(&font);
  const auto button = [&](const char* words, float button_px, bool is_on) {
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Button, is_on ? kButtonOn : kButton);
    const bool is_pressed = ImGui::Button(words, {button_px, 1.6f * em});
    ImGui::PopStyleColor();
    return is_pressed;
  };
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("teacher", nullptr, kFixed)) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name.c_str());
    if (note.empty()) {
      if (button("-", sign, false)) choices.speed = changed_speed(choices.speed, -1);
      ImGui::SameLine();
      const float right = ImGui::GetCursorPosX() + percent;
      ImGui::SetCursorPosX(right - width_of(font, speed));
      ImGui::TextUnformatted(speed.c_str());
      if (button("+", sign, false)) choices.speed = changed_speed(choices.speed, 1);
      if (button(texts[Text::kTeacherMirror], mirror, choices.is_mirrored))
        choices.is_mirrored = !choices.is_mirrored;
      if (button(texts[Text::kTeacherOver], over, choices.is_over))
        choices.is_over = !choices.is_over;
    }
  }
  ImGui::End();
  ImGui::PopFont();
  ImGui::PopStyleColor(2);
  ImGui::PopStyleVar(6);
  return top_px + height;
}

}  // namespace dance
