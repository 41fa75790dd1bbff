// The dance panel, drawn and worked with: mouse alone, keyboard alone, long names, thirty guests,
// three languages, two scales.
#include "tests/viewer/dance_panel/dance_stage.h"

namespace dance {
namespace {

class DancePictureTest : public DanceStage {
 protected:
  // A captured face at rest, which neither blinks nor looks around.
  void rest_faces() {
    for (SceneGuest& guest : scene_.guests) guest.face.emplace().presence = kFaceSeen | kGazeSeen;
  }
};

std::vector<Line> all_sorts() {
  return {{"alice", false},
          {"bob", true, 1},
          {"carla", true, 0, 140.0},
          {"dora", true, 0, 40.0, true},
          {"emil"}};
}

TEST_F(DancePictureTest, EscOpensAndClosesItAndTheMiddleStaysFree) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  rest_faces();
  const Picture closed = draw();
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_TRUE(panel_->is_open());
  const Picture open = keep("dance-couple");
  EXPECT_GT(changed(closed, open, 960, kWidth_px), 20'000);
  EXPECT_EQ(changed(closed, open, 0, 960), 0) << "three quarters of the picture are the dancers'";
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_FALSE(panel_->is_open());
}

TEST_F(DancePictureTest, AButtonInTheCornerOpensItWhereTheMouseMoves) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  const Picture still = draw();
  EXPECT_EQ(changed(still, draw(), 1200, kWidth_px), 0);
  move(400.0f, 400.0f);
  move(410.0f, 400.0f);
  EXPECT_GT(changed(still, keep("dance-corner"), 1200, kWidth_px), 300);
  for (int i = 0; i < 4 * 62; ++i) turn();
  EXPECT_EQ(changed(still, draw(), 1200, kWidth_px), 0) << "and hides again";
  move(1250.0f, 24.0f);
  click(1250.0f, 24.0f);
  EXPECT_TRUE(panel_->is_open());
}

TEST_F(DancePictureTest, EverythingIsReachedWithTheKeyboardAlone) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  tell_of(all_sorts());
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(press(GLFW_KEY_B)) << "talking is the window's";
  EXPECT_TRUE(find_with_keys([&] { return wishes_.mute_presses > 0; }));
  EXPECT_TRUE(find_with_keys([&] { return wishes_.deafen_presses > 0; }));
  EXPECT_TRUE(find_with_keys([&] { return !wishes_.hidden.empty(); }));
  EXPECT_TRUE(find_with_keys([&] { return !told_.empty(); }));
  EXPECT_TRUE(find_with_keys([&] { return wishes_.leaves; }));
}

TEST_F(DancePictureTest, RemovingAsksBackAndASecondEnterRemovesNobody) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  turn();
  // Music, count in, microphone, loudspeaker, alice, bob; of bob: mute, hide, remove.
  const auto press_remove = [&] {
    for (int i = 0; i < 9; ++i) press(GLFW_KEY_DOWN);
    press(GLFW_KEY_ENTER);
    turn();
  };
  press_remove();
  keep("dance-remove");
  press(GLFW_KEY_ENTER);
  turn();
  EXPECT_FALSE(board_.take_asked());
  panel_->open(false);
  panel_->open(true);
  turn();
  press_remove();
  press(GLFW_KEY_UP);
  press(GLFW_KEY_ENTER);
  turn();
  const auto asked = board_.take_asked();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->guest, guest_called("bob"));
}

TEST_F(DancePictureTest, OnlyAHostHasAButtonThatRemoves) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  turn();
  const Picture host = draw();
  link_->may_remove = false;
  turn();
  EXPECT_GT(changed(host, draw(), 960, kWidth_px), 300);
}

TEST_F(DancePictureTest, EverythingIsReachedWithTheMouseAlone) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  tell_of({{"alice", false}, {"bob"}});
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.mute_presses > 0; }));
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.deafen_presses > 0; }));
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.leaves; }));
  panel_->choose(guest_called("bob"));
  EXPECT_TRUE(find_with_mouse([&] {
    panel_->choose(guest_called("bob"));
    return !told_.empty();
  }));
  EXPECT_TRUE(find_with_mouse([&] {
    panel_->choose(guest_called("bob"));
    return !wishes_.hidden.empty();
  }));
}

TEST_F(DancePictureTest, ArrowsChangeTheVolumeOfTheChosenGuest) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  draw();
  for (int i = 0; i < 40 && told_.empty(); ++i) {
    press(GLFW_KEY_DOWN);
    press(GLFW_KEY_LEFT);
  }
  ASSERT_EQ(told_, std::vector<std::string>{"alice: volume bob=0.90"});
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_RIGHT);
  EXPECT_EQ(told_.back(), "alice: volume bob=1.10");
}

TEST_F(DancePictureTest, ThisHousesMusicIsMadeSofterAndKeptOnceItRests) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  draw();
  for (int i = 0; i < 40 && music_told_.empty(); ++i) {
    press(GLFW_KEY_DOWN);
    press(GLFW_KEY_LEFT);
  }
  ASSERT_EQ(music_told_.size(), 1u);
  EXPECT_NEAR(music_told_[0], 0.55, 1e-6);
  press(GLFW_KEY_LEFT);
  EXPECT_NEAR(music_told_.back(), 0.5, 1e-6);
  EXPECT_TRUE(music_kept_.empty()) << "it may still move";
  for (int i = 0; i < 62; ++i) turn();
  ASSERT_EQ(music_kept_.size(), 1u);
  EXPECT_NEAR(music_kept_[0], 0.5, 1e-6);
  keep("dance-music-volume");
  press(GLFW_KEY_RIGHT);
  panels_ = PanelStack();
  ASSERT_EQ(music_kept_.size(), 2u) << "the window closes";
  EXPECT_NEAR(music_kept_[1], 0.55, 1e-6);
}

TEST_F(DancePictureTest, WhereNothingPlaysHereNoVolumeIsOffered) {
  plays_music_ = false;
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  for (int i = 0; i < 40; ++i) {
    press(GLFW_KEY_DOWN);
    press(GLFW_KEY_LEFT);
  }
  EXPECT_TRUE(music_told_.empty());
}

TEST_F(DancePictureTest, AHiddenGuestIsToldToTheLink) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  press(GLFW_KEY_ESCAPE);
  ASSERT_TRUE(find_with_keys([&] { return !wishes_.hidden.empty(); }));
  const DanceBoard::HiddenGuests* hidden = board_.take_hidden();
  ASSERT_NE(hidden, nullptr);
  EXPECT_EQ((*hidden)[0], wishes_.hidden[0]);
  EXPECT_FALSE((*hidden)[1].is_set());
  EXPECT_EQ(board_.take_hidden(), nullptr) << "once";
}

TEST_F(DancePictureTest, VolumesAreToldAgainToAVoiceThatBeginsAnew) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->records().choice_of(guest_called("bob")).is_voice_muted = true;
  draw();
  const auto voices = scene_.voices;
  told_.clear();
  scene_.voices.clear();
  draw();
  scene_.voices = voices;
  draw();
  draw();
  EXPECT_EQ(told_, std::vector<std::string>{"alice: volume bob=0.00"});
}

TEST_F(DancePictureTest, LooksFineWithTroubleInThreeLanguages) {
  for (const LanguageName& language : kLanguages) {
    panels_ = PanelStack();
    painter_.reset();
    begin(language.language, kWidth_px, kHeight_px, 1.0f);
    tell_of(all_sorts());
    panel_->open(true);
    panel_->choose(guest_called("bob"));
    link_->state = HouseLinkState::kLapsed;
    for (int i = 0; i < 260; ++i) turn();
    const Picture picture = keep("dance-trouble-" + std::string(language.code));
    EXPECT_GT(picture.rgb.size(), 0u);
    link_->state = HouseLinkState::kConnected;
  }
}

TEST_F(DancePictureTest, ThirtyGuestsWithLongNamesScrollAndTheKeyboardReachesTheLast) {
  for (const float scale : {1.0f, 2.0f}) {
    panels_ = PanelStack();
    painter_.reset();
    begin(Language::kGerman, static_cast<int>(scale * kWidth_px),
          static_cast<int>(scale * kHeight_px), scale);
    std::vector<Line> lines{{"alice", false}};
    for (int i = 0; i < 30; ++i)
      lines.push_back({"mmmmwwww-dancer-from-" + std::to_string(100 + i), true, i % 7 == 3 ? 1 : 0,
                       i % 5 == 2 ? 150.0 : 40.0});
    tell_of(lines);
    panel_->open(true);
    keep("dance-thirty-" + std::to_string(static_cast<int>(scale)));
    panel_->choose(guest_called("mmmmwwww-dancer-from-129"));
    press(GLFW_KEY_UP);  // from the end: leave, picture, record, and the last guest's controls
    for (int i = 0; i < 3; ++i) press(GLFW_KEY_UP);
    for (int i = 0; i < 4; ++i) turn();
    keep("dance-thirty-last-" + std::to_string(static_cast<int>(scale)));
    told_.clear();
    for (int i = 0; i < 8 && told_.empty(); ++i) {
      press(GLFW_KEY_RIGHT);
      press(GLFW_KEY_UP);
    }
    ASSERT_FALSE(told_.empty());
    EXPECT_EQ(told_.back(), "alice: volume mmmmwwww-dancer-from-129=1.10");
  }
}

TEST_F(DancePictureTest, ShowsArrivalsAboveTheDancersForFiveSeconds) {
  begin(Language::kSpanish, kWidth_px, kHeight_px, 1.0f);
  rest_faces();
  for (int i = 0; i < 5 * 62; ++i) turn();
  const Picture before = draw();
  lines_.push_back({"carla"});
  for (int i = 0; i < 80; ++i) turn();
  EXPECT_GT(changed(before, keep("dance-arrival"), 400, 880), 2000);
  for (int i = 0; i < 6 * 62; ++i) turn();
  EXPECT_LT(changed(before, draw(), 400, 880), 500) << "for some seconds";
}

TEST_F(DancePictureTest, ShowsWhichOtherHousesRecord) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  const ShownNames::Named bob{guest_called("bob"), *parse_shown_name("Bob Dyl\u00e1n")};
  scene_.names = ShownNames({&bob, 1}, {});
  const Picture before = keep("recorded-by-nobody");
  scene_.recorders = {guest_called("bob")};
  scene_.guests[1].is_recording = true;
  const Picture recorded = keep("recorded-by-bob");
  EXPECT_GT(changed(before, recorded, kWidth_px / 2 - 80, kWidth_px / 2 + 80), 300);
}

TEST_F(DancePictureTest, AsksAHostBeforeTheRoomEnds) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  wishes_.closing = Closing::kAsked;
  draw();
  keep("dance-closing");
  EXPECT_EQ(wishes_.closing, Closing::kAsked);
  press(GLFW_KEY_ESCAPE);
  EXPECT_EQ(wishes_.closing, Closing::kNo);
  EXPECT_FALSE(panel_->is_open()) << "Esc was the answer";
  wishes_.closing = Closing::kAsked;
  const float x = 0.5f * kWidth_px;
  for (float y = 200.0f; y < 420.0f && wishes_.closing == Closing::kAsked; y += 11.0f)
    click(x - 190.0f, y);
  EXPECT_EQ(wishes_.closing, Closing::kYes);
}

TEST_F(DancePictureTest, SlowDrawingIsOneLineAtTheBottom) {
  begin(Language::kGerman, kWidth_px, kHeight_px, 1.0f);
  drawing_ = {true, true, true, 9.0f};
  scene_.guests.clear();  // nothing else moves
  scene_.music.reset();
  const Picture before = draw();
  for (int i = 0; i < 6 * 62; ++i) turn();
  EXPECT_TRUE(wishes_.knows_slow_drawing);
  const Picture picture = keep("dance-slow");
  int above = 0;
  for (int y = 0; y < kHeight_px * 3 / 4; ++y)
    for (int x = 0; x < kWidth_px; ++x) above += before.at(x, y) != picture.at(x, y) ? 1 : 0;
  EXPECT_EQ(above, 0) << "names and faces stay free";
  EXPECT_GT(changed(before, picture, 300, 980), 2000);
  for (int i = 0; i < 16 * 62; ++i) turn();
  EXPECT_LT(changed(before, draw(), 300, 980), 500);
}

TEST_F(DancePictureTest, CountsInAboveTheDancers) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  draw();
  const Picture before = draw();
  scene_.music->beats = 33.2;
  ASSERT_TRUE(find_with_keys([&] {
    scene_.music->beats = 36.1;
    const Picture picture = draw();
    const bool is_there = changed(before, picture, 500, 780) > 1500;
    scene_.music->beats = 33.2;
    draw();
    return is_there;
  }));
  scene_.music->beats = 38.05;
  keep("dance-count-in");
}

TEST_F(DancePictureTest, ARecordingThatCannotBeginIsABanner) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  EXPECT_TRUE(find_with_keys([&] { return !panel_->recording().trouble().empty(); }));
  const Picture picture = keep("dance-no-recording");
  panel_->open(false);
  const Picture closed = draw();
  EXPECT_GT(changed(closed, picture, 0, 900), 500) << "the banner moves with the column";
}

}  // namespace
}  // namespace dance
