// Tests pictures of the practice panel; DANCE_PICTURES names a folder to keep them.
#include "viewer/practice/practice_panel.h"

#include "tests/viewer/dance_panel/dance_stage.h"

namespace dance {
namespace {

constexpr int kGreenest[] = {95, 211, 141};  // of a beat that was met

class PracticePicture : public DanceStage {
 protected:
  void begin_practice(Language language) {
    begin(language, kWidth_px, kHeight_px, 1.0f);
    PracticeNeeds needs;
    needs.score = [this](MonoTime) { return score_; };
    needs.teacher = &choices_;
    needs.teacher_note = [this] { return note_; };
    auto panel = std::make_unique<PracticePanel>(std::move(needs));
    practice_ = panel.get();
    panels_.add(std::move(panel));
    painter_->overlay().set_language(language);
    turn();
  }
  static int met_pixels(const Picture& picture) {
    int count = 0;
    for (int y = 0; y < picture.height_px / 4; ++y)
      for (int x = 0; x < picture.width_px; ++x) {
        const auto pixel = picture.at(x, y);
        count += pixel[0] == kGreenest[0] && pixel[1] == kGreenest[1] && pixel[2] == kGreenest[2];
      }
    return count;
  }
  // A click on each place of the top left, until something is so.
  template <class Done>
  bool find_button(Done done) {
    for (float y = 14.0f; y < 60.0f; y += 12.0f)
      for (float x = 8.0f; x < 480.0f; x += 16.0f) {
        click(x, y);
        if (done()) return true;
      }
    return false;
  }

  std::optional<StepScore::Figures> score_;
  TeacherChoices choices_;
  std::string note_;
  PracticePanel* practice_ = nullptr;
};

StepScore::Figures nine_of_ten() {
  StepScore::Figures figures;
  figures.counted = 10;
  figures.met.fill(true);
  figures.met[4] = false;
  return figures;
}

TEST_F(PracticePicture, ShowsADotForEachBeatThatWasMetOnAKeyOnly) {
  begin_practice(Language::kEnglish);
  score_ = nine_of_ten();
  const Picture closed = draw();
  EXPECT_EQ(met_pixels(closed), 0);
  EXPECT_TRUE(press(GLFW_KEY_E));
  const Picture nine = keep("practice-nine");
  const int nine_px = met_pixels(nine);
  EXPECT_GT(nine_px, 300);
  score_->met.fill(false);
  score_->met[0] = score_->met[1] = score_->met[2] = true;
  EXPECT_NEAR(met_pixels(draw()), nine_px / 3, 0.05 * nine_px);
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_EQ(met_pixels(draw()), 0);
}

TEST_F(PracticePicture, TheTeacherIsChangedByKeysAndClicks) {
  begin_practice(Language::kGerman);
  EXPECT_FALSE(press(GLFW_KEY_COMMA)) << "closed";
  press(GLFW_KEY_E);
  EXPECT_TRUE(press(GLFW_KEY_COMMA));
  EXPECT_DOUBLE_EQ(choices_.speed, 0.9);
  EXPECT_TRUE(press(GLFW_KEY_PERIOD));
  EXPECT_DOUBLE_EQ(choices_.speed, 1.0);
  keep("practice-teacher");
  EXPECT_TRUE(find_button([this] { return choices_.is_mirrored; }));
  EXPECT_TRUE(find_button([this] { return choices_.is_over; }));
  EXPECT_TRUE(find_button([this] { return choices_.speed < 0.95; }));
  choices_.speed = TeacherChoices::kSlowest;
  EXPECT_TRUE(find_button([this] { return choices_.speed > TeacherChoices::kSlowest; }));
}

TEST(PracticeWords, LatenessIsToldInTensOfMillisecondsAndNotWhenSmall) {
  const Texts english(Language::kEnglish);
  StepScore::Figures figures = nine_of_ten();
  figures.late_ms = 64.0f;
  EXPECT_EQ(lateness_words(figures, english), "Steps come 60 ms late");
  figures.late_ms = -87.0f;
  EXPECT_EQ(lateness_words(figures, english), "Steps come 90 ms early");
  figures.late_ms = 30.0f;
  EXPECT_EQ(lateness_words(figures, english), "");
  figures.late_ms = 64.0f;
  figures.counted = 3;
  EXPECT_EQ(lateness_words(figures, english), "") << "too few";
}

}  // namespace
}  // namespace dance
