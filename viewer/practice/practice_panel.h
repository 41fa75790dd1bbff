// PracticePanel: key E: how many of the dancer's last ten beats were met, as ten dots and in words,
// and whether the steps come early or late. With a recorded teacher on the stage, its speed, mirror
// and place.
// It is at the top left, where it hides no feet.
//
// Units/frames: as WindowPanel.
// Ownership:    borrows scores and choices, which must outlive it.
// Threads:      the drawing thread.
// Failure:      without music or steps it says so.
#pragma once

#include <functional>
#include <optional>

#include "viewer/panel/window_panel.h"
#include "viewer/practice/step_score.h"
#include "viewer/practice/teacher_place.h"

namespace dance {

struct PracticeNeeds {
  // The dancer's score; nullopt while nobody is captured in this house.
  std::function<std::optional<StepScore::Figures>(MonoTime now)> score;
  TeacherChoices* teacher = nullptr;  // changed by hand; null: there is none
  // The reason why the teacher is not on the stage; "" = none.
  std::function<std::string()> teacher_note = {};
};

class PracticePanel : public WindowPanel {
 public:
  explicit PracticePanel(PracticeNeeds needs) : needs_(std::move(needs)) {}

  void open(bool is_open) { is_open_ = is_open; }

  Text title() const override { return Text::kKeysPractice; }
  std::span<const KeyHelp> keys() const override;
  // Never takes keys of other panels: it may stay on the whole evening.
  bool on_key(const KeyPress& press) override;
  void draw(const PanelFrame& frame) override;

 private:
  // Returns the lower edge.
  float draw_teacher(const PanelFrame& frame, float left_px, float top_px);

  PracticeNeeds needs_;
  bool is_open_ = false;
};

// The line below the dots; "" where the steps are neither early nor late on the whole.
std::string lateness_words(const StepScore::Figures& figures, const Texts& texts);

}  // namespace dance
