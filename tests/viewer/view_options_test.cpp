#include "viewer/program/view_options.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(PlanMoments, TakesOnePictureAtTheEndUnlessToldOtherwise) {
  EXPECT_EQ(*plan_moments({{}, 0.0, 7.0, 0}), (std::vector<double>{7.0}));
}

TEST(PlanMoments, SortsTheMomentsGiven) {
  EXPECT_EQ(*plan_moments({{8, 2, 5}, 0.0, 0.0, 0}), (std::vector<double>{2, 5, 8}));
}

TEST(PlanMoments, RepeatsUntilTheEnd) {
  EXPECT_EQ(*plan_moments({{}, 0.5, 2.0, 0}), (std::vector<double>{0.5, 1.0, 1.5, 2.0}));
}

TEST(PlanMoments, SpreadsAStripOverTheTime) {
  EXPECT_EQ(*plan_moments({{}, 0.0, 4.0, 4}), (std::vector<double>{1, 2, 3, 4}));
}

TEST(PlanMoments, GoesOnToTheEndOfARecordedHouse) {
  EXPECT_EQ(*plan_moments({{}, 2.0, 0.0, 0}, 7.0), (std::vector<double>{2, 4, 6}));
  EXPECT_EQ(*plan_moments({{}, 0.0, 0.0, 4}, 8.0), (std::vector<double>{2, 4, 6, 8}));
  EXPECT_EQ(*plan_moments({{}, 2.0, 4.0, 0}, 7.0), (std::vector<double>{2, 4})) << "as asked for";
  EXPECT_EQ(*plan_moments({{}, 0.0, 0.0, 0}, 7.0), (std::vector<double>{3})) << "one picture";
  EXPECT_EQ(*plan_moments({{}, 0.0, 0.0, 0}, 2.0), (std::vector<double>{2})) << "a short one";
}

TEST(PlanMoments, RefusesMomentsThatNobodyRecorded) {
  EXPECT_TRUE(plan_moments({{2.0, 5.0}, 0.0, 0.0, 0}, 5.0));
  const auto late = plan_moments({{2.0, 100.0}, 0.0, 0.0, 0}, 5.0);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().what, "--at 100: the recording is 5.0 s long");
}

TEST(PlanMoments, RefusesTwoPlansAndTooManyPictures) {
  EXPECT_FALSE(plan_moments({{1.0}, 0.5, 0.0, 0}));
  EXPECT_FALSE(plan_moments({{}, 0.02, 86400.0, 0}));
}

TEST(PlanMoments, AFilmGoesOnToItsEndAndTakesNoOtherPlan) {
  MomentWish wish;
  wish.film = true;
  wish.seconds = 6.0;
  EXPECT_EQ(*plan_moments(wish), (std::vector<double>{6.0}));
  wish.seconds = 0.0;
  EXPECT_GT(plan_moments(wish)->at(0), 3600.0);
  wish.strip = 4;
  EXPECT_FALSE(plan_moments(wish));
}

TEST(CheckShown, RefusesToChooseThePosesOfALogAndNamesTheCure) {
  for (const Shown shown : {Shown::kBest, Shown::kCapture, Shown::kGuest, Shown::kStage}) {
    ViewOptions options;
    options.feed.shown = shown;
    EXPECT_TRUE(check_shown(options)) << "a live house";
    options.log = "night.lcm";
    const auto checked = check_shown(options);
    EXPECT_EQ(checked.has_value(), shown == Shown::kBest);
    if (!checked) {
      EXPECT_NE(checked.error().what.find("--stage-only"), std::string::npos);
    }
  }
}

TEST(PlaceToDraw, IsTheStudioForPeopleAndPlainForPicturesThatAreCompared) {
  ViewOptions options;
  EXPECT_EQ(place_to_draw(options), Venue::kStudio) << "a window";
  options.headless = true;
  EXPECT_EQ(place_to_draw(options), Venue::kPlain);
  options.export_to = "night.mp4";
  EXPECT_EQ(place_to_draw(options), Venue::kStudio) << "an export";
  for (const PlaceName& it : kPlaceNames) {
    options.place = it.place;
    EXPECT_EQ(place_to_draw(options), it.place);
  }
}

TEST(ParseSize, TakesWidthByHeight) {
  const auto size = parse_size("640x360");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width_px, 640);
  EXPECT_EQ(size->height_px, 360);
}

TEST(ParseSize, RefusesEverythingElseInOneLine) {
  for (const char* text : {"", "640", "640x", "x360", "640x360x2", "640 x 360", "0x0", "-640x360",
                           "99999x10", "640x36o", "99999999999999999999x360", "63x64"}) {
    const auto size = parse_size(text);
    ASSERT_FALSE(size) << text;
    EXPECT_EQ(size.error().what.find('\n'), std::string::npos);
    EXPECT_NE(size.error().what.find("1280x720"), std::string::npos);
  }
}

TEST(CheckTeacher, NeedsARecordingALiveHouseAndAWindow) {
  ViewOptions options;
  EXPECT_TRUE(check_teacher(options));
  options.teacher.choices.speed = 0.5;
  EXPECT_FALSE(check_teacher(options)) << "whose speed?";
  options.teacher.file = "lesson.bvh";
  EXPECT_TRUE(check_teacher(options));
  options.headless = true;
  EXPECT_FALSE(check_teacher(options));
  options.headless = false;
  options.log = "evening.lcm";
  EXPECT_FALSE(check_teacher(options));
}

}  // namespace
}  // namespace dance
