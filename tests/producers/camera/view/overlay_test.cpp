#include "producers/camera/view/overlay.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

#include "tests/producers/camera/view/standing_body.h"

namespace dance {
namespace {

cv::Mat black() { return cv::Mat(200, 160, CV_8UC3, cv::Scalar::all(0)); }
bool is_drawn(const cv::Mat& picture, int x, int y) {
  const auto& p = picture.at<cv::Vec3b>(y, x);
  return p[0] + p[1] + p[2] > 60;
}

TEST(Overlay, DrawsTheLimbsWhereTheyAre) {
  cv::Mat picture = black();
  draw_landmarks(picture, standing_body());
  EXPECT_TRUE(is_drawn(picture, 92, 120)) << "left thigh";
  EXPECT_TRUE(is_drawn(picture, 68, 155)) << "right shank";
  EXPECT_FALSE(is_drawn(picture, 80, 150)) << "between the legs";
  const auto& left = picture.at<cv::Vec3b>(120, 92);
  const auto& right = picture.at<cv::Vec3b>(120, 68);
  EXPECT_GT(left[2], left[0]) << "the dancer's left is warm";
  EXPECT_GT(right[0], right[2]) << "the right is cool";
}

TEST(Overlay, DrawsNobodyWhereNobodyIs) {
  cv::Mat picture = black();
  BodyLandmarks body = standing_body();
  body.found = false;
  draw_landmarks(picture, body);
  EXPECT_EQ(cv::countNonZero(picture.reshape(1)), 0);
}

TEST(Overlay, BearsPointsThatAreNowhere) {
  cv::Mat picture = black();
  BodyLandmarks body = standing_body();
  body.image_px[index_of(Landmark::kLeftKnee)] = {std::numeric_limits<float>::quiet_NaN(), 1e30f,
                                                  0.0f};
  body.image_px[index_of(Landmark::kNose)] = {-1e9f, 1e9f, 0.0f};
  draw_landmarks(picture, body);
  draw_caption(
      picture,
      "a caption that is far too long for a picture this small, and is cut off at its edge");
  EXPECT_TRUE(is_drawn(picture, 68, 155));
}

}  // namespace
}  // namespace dance
