#include "producers/camera/solver/camera_placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "producers/camera/solver/observation.h"

namespace dance {
namespace {

// A floor seen by a camera so high, looking down so far.
Eigen::Vector3d on_floor(double x, double z, double height_m, double pitch_rad) {
  // height = n·p with the floor's down direction n = (0, cos, −sin) in C.
  return {x, (height_m - z * std::sin(pitch_rad)) / std::cos(pitch_rad), z};
}

TEST(CameraPlacement, FindsTheFloorFromFeetThatWalkOnIt) {
  Random random(3);
  CameraPlacement placement;
  for (int i = 0; i < 600; ++i) {
    placement.add_foot(on_floor(random.uniform(-1.0, 1.0), random.uniform(2.0, 5.0), 1.6, 0.2));
    placement.update();
  }
  EXPECT_TRUE(placement.is_settled());
  EXPECT_NEAR(placement.height_m(), 1.6, 0.02);
  EXPECT_NEAR(placement.pitch_rad(), 0.2, 0.01);
  const Eigen::Vector3d p_W = placement.to_W(on_floor(0.3, 3.0, 1.6, 0.2));
  EXPECT_NEAR(p_W.y(), 0.0, 0.01);
}

TEST(CameraPlacement, OfOneWhoStandsStillUprightDecidesTheTilt) {
  CameraPlacement placement;
  for (int i = 0; i < 300; ++i) {
    placement.add_upright({0.0, -std::cos(0.2), -std::sin(0.2)});
    placement.add_foot(on_floor(0.0, 3.0, 1.6, 0.2));
    placement.update();
  }
  EXPECT_NEAR(placement.pitch_rad(), 0.2, 0.06);
  EXPECT_NEAR(placement.to_W(on_floor(0.0, 3.0, 1.6, 0.2)).y(), 0.0, 0.02);
}

TEST(CameraPlacement, GoesToCAndBack) {
  CameraPlacement placement;
  placement.set_origin({0.4, 0.9, 3.1});
  const Eigen::Vector3d p(0.3, 1.1, -0.7);
  EXPECT_LT((placement.to_W(placement.to_C(p)) - p).norm(), 1e-12);
  const Eigen::Vector3d origin = placement.to_W({0.4, 0.9, 3.1});
  EXPECT_NEAR(origin.x(), 0.0, 1e-9);
  EXPECT_NEAR(origin.z(), 0.0, 1e-9);
}

TEST(CameraPlacement, WhateverFeetDoTheCameraStaysPlausible) {
  Random random(5);
  CameraPlacement placement;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10.0, random.uniform(-3.0, 6.0));
    const double bad = i % 7 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
    placement.add_foot(
        {size * random.normal(), bad * size * random.normal(), size * random.normal()});
    placement.add_upright({random.normal(), bad * random.normal(), random.normal()});
    placement.update();
    ASSERT_GE(placement.height_m(), 0.05);
    ASSERT_LE(placement.height_m(), 5.0);
    ASSERT_LE(std::abs(placement.pitch_rad()), 0.8);
    ASSERT_TRUE(placement.R_WC().allFinite());
    ASSERT_LT(
        (placement.R_WC() * placement.R_WC().transpose() - Eigen::Matrix3d::Identity()).norm(),
        1e-9);
  }
}

TEST(Observation, ABodyOfKnownShapeIsPlacedWhereItIs) {
  Random random(6);
  Observation seen;
  std::array<Eigen::Vector3d, kLandmarkCount> relative;
  const Eigen::Vector3d place(0.7, 0.2, 3.4);
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    relative[i] = {0.4 * random.normal(), 0.6 * random.normal(), 0.3 * random.normal()};
    const Eigen::Vector3d p = place + relative[i];
    seen.ray[i] = p.head<2>() / p.z();
    seen.weight[i] = 1.0;
  }
  Eigen::Vector3d found;
  ASSERT_TRUE(place_on_rays(seen, relative, found));
  EXPECT_LT((found - place).norm(), 1e-4);
}

TEST(Observation, RaysAreFreedFromTheLens) {
  Pinhole camera = assumed_pinhole(1280, 720);
  camera.distortion = {-0.25, 0.08, 0.001, -0.0005, 0.0};
  BodyLandmarks landmarks;
  landmarks.found = true;
  const Eigen::Vector2d ray(0.35, -0.2);
  const double r2 = ray.squaredNorm();
  const double radial = 1.0 + camera.distortion[0] * r2 + camera.distortion[1] * r2 * r2;
  const Eigen::Vector2d bent =
      radial * ray +
      Eigen::Vector2d(2.0 * 0.001 * ray.x() * ray.y() - 0.0005 * (r2 + 2.0 * ray.x() * ray.x()),
                      0.001 * (r2 + 2.0 * ray.y() * ray.y()) - 2.0 * 0.0005 * ray.x() * ray.y());
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    landmarks.image_px[i] = {static_cast<float>(camera.fx_px * bent.x() + camera.cx_px + 0.5),
                             static_cast<float>(camera.fy_px * bent.y() + camera.cy_px + 0.5),
                             0.0f};
    landmarks.world_m[i].setZero();
    landmarks.visibility[i] = 1.0f;
  }
  EXPECT_LT((observe(landmarks, camera).ray[0] - ray).norm(), 1e-4);
}

}  // namespace
}  // namespace dance
