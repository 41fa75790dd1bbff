#include "viewer/scene/camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

using Eigen::Vector3f;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kWidth_px = 1280.0f;
constexpr float kHeight_px = 720.0f;

TEST(OrbitCamera, LooksAtItsTargetInTheMiddleOfThePicture) {
  for (const float yaw : {0.0f, 1.0f, 3.0f, -2.0f}) {
    OrbitCamera camera;
    camera.yaw_rad = yaw;
    camera.target_W_m = Vector3f(1.0f, 2.0f, -3.0f);
    const auto at = project(camera, camera.target_W_m, kWidth_px, kHeight_px);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x_px, 640.0f, 0.05f);
    EXPECT_NEAR(at->y_px, 360.0f, 0.05f);
    EXPECT_NEAR(at->depth_m, camera.distance_m, 1e-4f);
  }
}

TEST(OrbitCamera, SeesTheLeftHandOfWhoFacesItOnTheRight) {
  OrbitCamera camera;
  camera.yaw_rad = 0.0f;
  const auto left_hand = project(camera, Vector3f(0.8f, 1.4f, 0.0f), kWidth_px, kHeight_px);
  ASSERT_TRUE(left_hand);
  EXPECT_GT(left_hand->x_px, 700.0f);
  EXPECT_LT(left_hand->y_px, 360.0f) << "above the target is above the middle";
}

TEST(OrbitCamera, HasNoPlaceOnTheScreenForWhatLiesBehindIt) {
  OrbitCamera camera;
  EXPECT_FALSE(project(camera, camera.eye_W_m() + camera.axes_W().col(2), kWidth_px, kHeight_px));
}

TEST(FramePoints, HasEveryPointInsideAndOneOnTheEdge) {
  Random random(11);
  for (int round = 0; round < 50; ++round) {
    std::vector<Vector3f> points;
    for (int i = 0; i < 20; ++i)
      points.emplace_back(random.uniform(-4, 4), random.uniform(0, 2), random.uniform(-4, 4));
    OrbitCamera camera;
    camera.yaw_rad = static_cast<float>(random.uniform(-3, 3));
    camera.pitch_rad = static_cast<float>(random.uniform(0, 1.2));
    const OrbitCamera framed = frame_points(camera, points, kWidth_px / kHeight_px, 0.8f);
    float furthest = 0.0f;
    for (const Vector3f& p : points) {
      const auto at = project(framed, p, 2.0f * kWidth_px / kHeight_px, 2.0f);
      ASSERT_TRUE(at) << "round " << round;
      const float x = std::abs(at->x_px * kHeight_px / kWidth_px - 1.0f);
      const float y = std::abs(at->y_px - 1.0f);
      furthest = std::max({furthest, x, y});
    }
    EXPECT_LE(furthest, 0.8f + 2e-3f) << "round " << round;
    EXPECT_GE(furthest, 0.8f - 2e-3f) << "the nearest such camera touches an edge, round " << round;
  }
}

TEST(FramePoints, LeavesWhatIsCoveredAtTheBottomFree) {
  OrbitCamera camera;
  camera.pitch_rad = 0.13f;
  const std::vector<Vector3f> couple{
      {-0.4f, 0, 0}, {0.4f, 0, 0.2f}, {-0.4f, 1.7f, 0}, {0.4f, 1.8f, 0}};
  const float covered = 0.2f;
  const OrbitCamera framed = frame_points(camera, couple, kWidth_px / kHeight_px, 0.86f, covered);
  float highest = kHeight_px, lowest = 0.0f;
  for (const Vector3f& p : couple) {
    const auto at = project(framed, p, kWidth_px, kHeight_px);
    ASSERT_TRUE(at);
    highest = std::min(highest, at->y_px);
    lowest = std::max(lowest, at->y_px);
  }
  // The same margin above and below, of what is seen.
  const float seen_px = (1.0f - covered) * kHeight_px;
  EXPECT_NEAR(highest, 0.07f * seen_px, 1.0f);
  EXPECT_NEAR(lowest, seen_px - 0.07f * seen_px, 1.0f);
}

TEST(FramePoints, KeepsTheDirection) {
  OrbitCamera camera;
  camera.yaw_rad = 1.1f;
  camera.pitch_rad = 0.4f;
  const std::vector<Vector3f> points{{0, 0, 0}, {3, 1.7f, 1}};
  const OrbitCamera framed = frame_points(camera, points, 1.5f, 0.9f);
  EXPECT_EQ(framed.yaw_rad, camera.yaw_rad);
  EXPECT_EQ(framed.pitch_rad, camera.pitch_rad);
}

TEST(FramePoints, LeavesTheCameraAloneWhenNobodyIsThere) {
  const OrbitCamera camera;
  const OrbitCamera framed = frame_points(camera, {}, 1.5f, 0.9f);
  EXPECT_EQ(framed.target_W_m, camera.target_W_m);
  EXPECT_EQ(framed.distance_m, camera.distance_m);
}

TEST(BestYaw, LooksAcrossTheLineOfACouple) {
  for (const float turn : {0.0f, 0.7f, 1.5f, 2.8f}) {
    const Eigen::Quaternionf R(Eigen::AngleAxisf(turn, Vector3f::UnitY()));
    const std::vector<Vector3f> hips{R * Vector3f(0.4f, 1, 0), R * Vector3f(-0.4f, 1, 0)};
    const std::vector<Vector3f> facing{R * Vector3f(-1, 0, 0), R * Vector3f(1, 0, 0)};
    OrbitCamera camera;
    camera.yaw_rad = best_yaw_rad(hips, facing);
    const Vector3f line = (hips[0] - hips[1]).normalized();
    EXPECT_NEAR(std::abs(camera.axes_W().col(0).dot(line)), 1.0f, 1e-3f) << "turned by " << turn;
  }
}

TEST(BestYaw, SeesTheFacesOfARow) {
  for (const float turn : {0.0f, kPi, 2.0f}) {
    const Eigen::Quaternionf R(Eigen::AngleAxisf(turn, Vector3f::UnitY()));
    std::vector<Vector3f> hips;
    std::vector<Vector3f> facing;
    for (int i = 0; i < 5; ++i) {
      hips.push_back(R * Vector3f(static_cast<float>(i), 1, 0));
      facing.push_back(R * Vector3f::UnitZ());
    }
    OrbitCamera camera;
    camera.yaw_rad = best_yaw_rad(hips, facing);
    camera.pitch_rad = 0.0f;
    EXPECT_NEAR(camera.axes_W().col(2).dot(facing[0]), 1.0f, 1e-3f);
  }
}

TEST(BestYaw, SeesASingleDancersFace) {
  const std::vector<Vector3f> hips{{0, 1, 0}};
  const std::vector<Vector3f> facing{{1, 0, 0}};
  OrbitCamera camera;
  camera.yaw_rad = best_yaw_rad(hips, facing);
  EXPECT_GT(camera.axes_W().col(2).dot(facing[0]), 0.85f);
}

TEST(LightBox, HoldsTheBallRoundItsCentreAndMovesInWholeTexels) {
  const Vector3f to_light = Vector3f(0.4f, 0.8f, 0.3f).normalized();
  const Vector3f centre(0.3f, 1.0f, -0.2f);
  const Eigen::Matrix4f clip = light_clip_from_world(to_light, centre, 3.0f, 1024);
  for (const Vector3f& direction : {Vector3f(1, 0, 0), Vector3f(0, 1, 0), Vector3f(0, 0, -1)}) {
    const Eigen::Vector4f q = clip * (centre + 2.98f * direction).homogeneous();
    EXPECT_LE(q.head<3>().cwiseAbs().maxCoeff(), 1.0f);
  }
  const Eigen::Matrix4f moved =
      light_clip_from_world(to_light, centre + Vector3f(0.123f, 0, 0), 3.0f, 1024);
  const Eigen::Vector4f shift = (moved - clip).col(3) * 512.0f;
  EXPECT_NEAR(shift.x(), std::round(shift.x()), 1e-2f);
  EXPECT_NEAR(shift.y(), std::round(shift.y()), 1e-2f);
}

}  // namespace
}  // namespace dance
