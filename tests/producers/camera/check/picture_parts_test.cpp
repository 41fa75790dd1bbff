// How a picture is lit and whether the view moves, of drawn pictures.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "producers/camera/check/picture_light.h"
#include "producers/camera/check/view_shake.h"
#include "tests/formats/camera_view/drawn_view.h"

namespace dance {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;

cv::Mat plain(int luma) { return {kHeight, kWidth, CV_8UC1, cv::Scalar(luma)}; }

// A room with things in it, larger than the picture; the same for each seed.
cv::Mat drawn_room(std::uint64_t seed) {
  cv::Mat room(kHeight + 80, kWidth + 80, CV_8UC1, cv::Scalar(110));
  cv::RNG random(seed);
  for (int i = 0; i < 150; ++i) {
    const cv::Point at(random.uniform(0, room.cols), random.uniform(0, room.rows));
    const cv::Size size(random.uniform(8, 40), random.uniform(8, 40));
    cv::rectangle(room, cv::Rect(at, size), cv::Scalar(random.uniform(30, 220)), cv::FILLED);
  }
  return room;
}

cv::Mat seen_of(const cv::Mat& room, int x, int y) {
  return room(cv::Rect(40 + x, 40 + y, kWidth, kHeight)).clone();
}

// A dark figure where the body is.
void draw_dancer(cv::Mat& picture, const SeenBody2d& body, int luma) {
  for (const SeenPoint& p : body.points)
    cv::circle(picture,
               {static_cast<int>(p.x * static_cast<float>(picture.cols)),
                static_cast<int>(p.y * static_cast<float>(picture.rows))},
               9, cv::Scalar(luma), cv::FILLED);
  const auto at = [&](std::size_t i) {
    return cv::Point(static_cast<int>(body.points[i].x * static_cast<float>(picture.cols)),
                     static_cast<int>(body.points[i].y * static_cast<float>(picture.rows)));
  };
  cv::rectangle(picture, cv::Rect(at(12), at(23)), cv::Scalar(luma), cv::FILLED);
}

TEST(PictureLight, MeasuresAnEvenPicture) {
  const PictureLight light = light_of(plain(102), {});
  EXPECT_NEAR(light.mean, 0.4f, 0.001f);
  EXPECT_EQ(light.spread, 0.0f);
  EXPECT_EQ(light.white_share, 0.0f);
  EXPECT_EQ(light.body, light.around);
}

TEST(PictureLight, MeasuresHowMuchIsWhiteAndHowFarAllIsSpread) {
  cv::Mat picture = plain(20);
  picture(cv::Rect(0, 0, kWidth, kHeight / 4)).setTo(255);
  const PictureLight light = light_of(picture, {});
  EXPECT_NEAR(light.white_share, 0.25f, 0.001f);
  EXPECT_NEAR(light.spread, 235.0f / 255.0f, 0.001f);
  EXPECT_NEAR(light.mean, (0.25f * 255.0f + 0.75f * 20.0f) / 255.0f, 0.001f);
}

TEST(PictureLight, ADarkDancerBeforeABrightWindowIsDarkerThanWhatIsAround) {
  const SeenBody2d body = standing_in(0.8f, 0.1f);
  cv::Mat picture = plain(230);
  draw_dancer(picture, body, 30);
  const PictureLight light = light_of(picture, body);
  EXPECT_LT(light.body, 0.2f);
  EXPECT_GT(light.around, 0.85f);
}

TEST(PictureLight, ADancerOutsideOfThePictureHasTheLightOfTheRest) {
  const PictureLight light = light_of(plain(100), standing_in(0.8f, 2.0f));
  EXPECT_NEAR(light.body, light.around, 0.01f);
}

TEST(PictureLight, ADancerWhoFillsThePictureHasNothingAround) {
  const PictureLight light = light_of(plain(100), standing_in(3.0f, -1.0f));
  EXPECT_NEAR(light.body, light.around, 0.01f);
}

// Pictures ten times a second, the view moved by (x, y) px a picture.
float shake_after(double seconds, cv::Point step, bool has_dancer, int light_step = 0) {
  ViewShake shake;
  const cv::Mat room = drawn_room(3);
  float value = 0.0f;
  for (int i = 0; i < static_cast<int>(seconds * 10.0); ++i) {
    // Back and forth, as what is held or shaken does.
    const int there = i / 10 % 2 == 0 ? i % 10 : 10 - i % 10;
    cv::Mat picture = seen_of(room, step.x * there, step.y * there);
    SeenBody2d body;
    if (has_dancer) {
      body = standing_in(0.8f, 0.1f, 0.5f + 0.02f * static_cast<float>(there));
      draw_dancer(picture, body, 60);
    }
    if (light_step != 0) picture += cv::Scalar(light_step * (i % 7));
    value = shake.see(picture, body, MonoTime::from_us(1 + i * 100'000));
  }
  return value;
}

TEST(ViewShake, ACameraThatStandsDoesNotMove) { EXPECT_EQ(shake_after(5.0, {0, 0}, false), 0.0f); }

TEST(ViewShake, ADancerWhoMovesDoesNotMoveTheView) {
  EXPECT_EQ(shake_after(5.0, {0, 0}, true), 0.0f);
}

TEST(ViewShake, ALightThatChangesDoesNotMoveTheView) {
  EXPECT_EQ(shake_after(5.0, {0, 0}, true, 6), 0.0f);
}

TEST(ViewShake, ACameraThatIsMovedMovesTheViewWithADancerBeforeItToo) {
  EXPECT_GT(shake_after(3.0, {1, 0}, true), 0.012f);
  EXPECT_GT(shake_after(3.0, {0, 1}, false), 0.012f);
}

TEST(ViewShake, ABareWallSaysNothing) {
  ViewShake shake;
  for (int i = 0; i < 30; ++i)
    EXPECT_EQ(shake.see(plain(100 + i), {}, MonoTime::from_us(1 + i * 100'000)), 0.0f);
}

TEST(ViewShake, AnotherSizeOfThePictureIsNoMotion) {
  ViewShake shake;
  const cv::Mat room = drawn_room(3);
  shake.see(seen_of(room, 0, 0), {}, MonoTime::from_us(1));
  cv::Mat other;
  cv::resize(room, other, {240, 240});
  EXPECT_EQ(shake.see(other, {}, MonoTime::from_us(2'000'000)), 0.0f);
}

}  // namespace
}  // namespace dance
