// The eyes of a headset: where points of the stage fall on their pictures.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "viewer/scene/camera.h"

namespace dance {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr int kEyeHeight_px = 500;

// From -1 to 1, to the right and up.
Vector3f on_picture(const StageEye& eye, const Vector3f& p_W_m) {
  return (eye.clip_from_world * p_W_m.homogeneous()).hnormalized();
}

TEST(StageEye, APointStraightAheadIsInTheMiddleOfAnEyeThatIsOpenEvenly) {
  const Vector3f at(1.0f, 1.6f, -2.0f);
  for (const float turn : {0.0f, 1.0f, -2.5f}) {
    const Matrix3f R = Eigen::AngleAxisf(turn, Vector3f(1.0f, 3.0f, 0.5f).normalized()).matrix();
    const StageEye eye = eye_at(at, R, {-1.0f, 1.0f, 0.8f, -0.8f}, kEyeHeight_px);
    EXPECT_EQ(eye.eye_W_m, at);
    for (const float distance_m : {0.1f, 2.0f, 50.0f}) {
      const Vector3f middle = on_picture(eye, at - distance_m * R.col(2));
      EXPECT_NEAR(middle.x(), 0.0f, 1e-4f);
      EXPECT_NEAR(middle.y(), 0.0f, 1e-4f);
    }
    const Vector3f right = on_picture(eye, at - R.col(2) + R.col(0));
    EXPECT_NEAR(right.x(), 1.0f, 1e-4f) << "the right edge";
    EXPECT_NEAR(on_picture(eye, at - R.col(2) + 0.8f * R.col(1)).y(), 1.0f, 1e-4f);
    const Eigen::Vector4f behind = eye.clip_from_world * (at + R.col(2)).homogeneous();
    EXPECT_LT(behind.w(), 0.0f);
  }
}

TEST(StageEye, AnEyeThatIsOpenUnevenlyHasItsEdgesWhereTheHeadsetHasThem) {
  const EyeTangents open{-1.2f, 0.9f, 0.7f, -1.1f};
  const StageEye eye = eye_at(Vector3f::Zero(), Matrix3f::Identity(), open, kEyeHeight_px);
  for (const float distance_m : {0.5f, 3.0f}) {
    const auto at = [&](float x, float y) {
      return on_picture(eye, distance_m * Vector3f(x, y, -1.0f));
    };
    EXPECT_NEAR(at(open.left, 0.0f).x(), -1.0f, 1e-5f);
    EXPECT_NEAR(at(open.right, 0.0f).x(), 1.0f, 1e-5f);
    EXPECT_NEAR(at(0.0f, open.up).y(), 1.0f, 1e-5f);
    EXPECT_NEAR(at(0.0f, open.down).y(), -1.0f, 1e-5f);
    EXPECT_GT(at(0.0f, 0.0f).x(), 0.1f) << "what is straight ahead is right of the middle";
    EXPECT_GT(at(0.0f, 0.0f).y(), 0.1f);
  }
}

TEST(StageEye, SeesWhatIsNearAndFarAndTheNearerInFront) {
  const StageEye eye =
      eye_at(Vector3f::Zero(), Matrix3f::Identity(), {-1.0f, 1.0f, 1.0f, -1.0f}, kEyeHeight_px);
  float last = -1.0f;
  for (const float distance_m : {0.041f, 0.1f, 1.0f, 10.0f, 399.0f}) {
    const float depth = on_picture(eye, {0.0f, 0.0f, -distance_m}).z();
    EXPECT_GT(depth, last) << distance_m;
    EXPECT_LT(depth, 1.0f);
    last = depth;
  }
  EXPECT_LT(on_picture(eye, {0.0f, 0.0f, -0.03f}).z(), -1.0f);
}

TEST(StageEye, OfAHeadsetIsThatOfACameraWithTheSameView) {
  OrbitCamera camera;
  camera.yaw_rad = 0.8f;
  camera.fov_y_rad = 1.2f;
  constexpr int kEyeWidth_px = 400;
  const StageEye same = eye_of(camera, kEyeWidth_px, kEyeHeight_px);
  const float up = std::tan(0.5f * camera.fov_y_rad);
  const float right = up * static_cast<float>(kEyeWidth_px) / static_cast<float>(kEyeHeight_px);
  const StageEye eye =
      eye_at(camera.eye_W_m(), camera.axes_W(), {-right, right, up, -up}, kEyeHeight_px);
  EXPECT_LT((eye.view_from_world - same.view_from_world).norm(), 1e-5f);
  EXPECT_NEAR(eye.px_at_1m, same.px_at_1m, 1e-2f);
  for (const Vector3f& p : {Vector3f(0.0f, 1.0f, 0.0f), Vector3f(-0.5f, 1.7f, 0.3f)}) {
    // But for the depth: the nearest that an eye sees is nearer.
    const Vector3f a = on_picture(eye, p), b = on_picture(same, p);
    EXPECT_NEAR(a.x(), b.x(), 1e-4f);
    EXPECT_NEAR(a.y(), b.y(), 1e-4f);
  }
}

}  // namespace
}  // namespace dance
