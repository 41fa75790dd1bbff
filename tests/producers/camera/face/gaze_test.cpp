#include "producers/camera/face/gaze.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "producers/camera/face/face_solver.h"

namespace dance {
namespace {

// Two eyes, white with dark irises that are so far to the dancer's left and up, in pixels.
struct DrawnEyes {
  cv::Mat picture{200, 300, CV_8UC3, cv::Scalar(150, 170, 200)};
  FaceLandmarks face;

  DrawnEyes(int left_px, int up_px, int gap_px = 16) {
    face.found = true;
    for (auto& p : face.image_px) p = {150.0f, 100.0f, 0.0f};
    const auto draw = [&](int x, std::size_t right, std::size_t left, std::size_t upper,
                          std::size_t lower) {
      cv::ellipse(picture, {x, 100}, {20, gap_px / 2}, 0.0, 0.0, 360.0, cv::Scalar::all(240),
                  cv::FILLED);
      cv::circle(picture, {x + left_px, 100 - up_px}, 6, cv::Scalar::all(40), cv::FILLED);
      const auto at = [](int px, int py) {
        return Eigen::Vector3f(static_cast<float>(px), static_cast<float>(py), 0.0f);
      };
      face.image_px[right] = at(x - 20, 100);
      face.image_px[left] = at(x + 20, 100);
      face.image_px[upper] = at(x, 100 - gap_px / 2);
      face.image_px[lower] = at(x, 100 + gap_px / 2);
    };
    draw(110, 33, 133, 159, 145);
    draw(190, 362, 263, 386, 374);
  }
};

TEST(Gaze, FollowsTheIrises) {
  const auto ahead = gaze_of(DrawnEyes(0, 0).picture, DrawnEyes(0, 0).face);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->x(), 0.0f, 0.06f);
  EXPECT_NEAR(ahead->y(), 0.0f, 0.06f);
  float last = -1.0f;
  for (int x = -8; x <= 8; x += 2) {
    const DrawnEyes eyes(x, 0);
    const auto gaze = gaze_of(eyes.picture, eyes.face);
    ASSERT_TRUE(gaze);
    EXPECT_GT(gaze->x(), last) << x;
    last = gaze->x();
  }
  EXPECT_GT(last, 0.25f);
  const DrawnEyes up(0, 3), down(0, -3);
  EXPECT_GT(gaze_of(up.picture, up.face)->y(), gaze_of(down.picture, down.face)->y() + 0.05f);
}

TEST(Gaze, IsNotToldOfClosedSmallOrAbsentEyes) {
  const DrawnEyes closed(0, 0, 4);
  EXPECT_FALSE(gaze_of(closed.picture, closed.face));
  DrawnEyes far(0, 0);
  for (auto& p : far.face.image_px) p *= 0.2f;
  EXPECT_FALSE(gaze_of(far.picture, far.face));
  DrawnEyes outside(0, 0);
  for (auto& p : outside.face.image_px) p.x() += 400.0f;
  EXPECT_FALSE(gaze_of(outside.picture, outside.face));
  EXPECT_FALSE(gaze_of(DrawnEyes(0, 0).picture, FaceLandmarks()));
  EXPECT_FALSE(gaze_of(cv::Mat(), DrawnEyes(0, 0).face));
}

TEST(Gaze, TheLeftEyeLooksOutWhereTheRightOneLooksIn) {
  FaceSolver solver;
  FaceLandmarks face = DrawnEyes(0, 0).face;
  face.image_px[10] = {150.0f, 20.0f, 0.0f};
  face.image_px[2] = {150.0f, 150.0f, 0.0f};
  face.image_px[152] = {150.0f, 190.0f, 0.0f};
  const auto at = [](int i) { return MonoTime{} + Duration::s(1) + Duration::ms(33 * i); };
  int i = 0;
  Face out;
  for (; i < 60; ++i) {
    solver.see(face, at(i));
    solver.see_gaze(Eigen::Vector2f(0.1f, -0.2f));
    solver.write(at(i), out);
    if (i < 59) {
      EXPECT_EQ(out.presence & kGazeSeen, 0u) << i;
    }
  }
  for (; i < 90; ++i) {
    solver.see(face, at(i));
    solver.see_gaze(Eigen::Vector2f(0.4f, -0.2f));
  }
  ASSERT_TRUE(solver.write(at(i), out));
  EXPECT_EQ(out.presence, kFaceSeen | kGazeSeen);
  EXPECT_NEAR(out.gaze_rad[0], 0.3f, 0.03f);
  EXPECT_NEAR(out.gaze_rad[1], 0.0f, 0.01f);
  EXPECT_NEAR(out[Expression::kEyeLookOutLeft], 0.5f, 0.05f);
  EXPECT_EQ(out[Expression::kEyeLookOutLeft], out[Expression::kEyeLookInRight]);
  EXPECT_EQ(out[Expression::kEyeLookInLeft], 0.0f);
  solver.see(face, at(i));
  solver.see_gaze(std::nullopt);
  solver.write(at(i), out);
  EXPECT_EQ(out.presence, kFaceSeen);
}

}  // namespace
}  // namespace dance
