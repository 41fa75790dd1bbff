#include "consumers/engine/adapter/axes.h"

#include <gtest/gtest.h>

#include "consumers/engine/dance_adapter.h"
#include "tests/core/pose/random_pose.h"

namespace dance::engine {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr dance_axes kAll[] = {DANCE_AXES_GLTF, DANCE_AXES_UNITY, DANCE_AXES_UNREAL,
                               DANCE_AXES_BLENDER};

Vector3f out(dance_axes axes, const Vector3f& p) {
  Vector3f turned;
  find_axes(axes)->point_out(p.data(), turned.data());
  return turned;
}

Quaternionf out(dance_axes axes, const Quaternionf& q) {
  Quaternionf turned;
  find_axes(axes)->rotations_out(q.coeffs().data(), turned.coeffs().data(), 1);
  return turned;
}

const Vector3f kLeft(1, 0, 0), kUp(0, 1, 0), kForward(0, 0, 1);

TEST(EngineAxes, TurnADancersDirectionsIntoTheEngines) {
  EXPECT_EQ(out(DANCE_AXES_GLTF, kForward), Vector3f(0, 0, 1));
  EXPECT_EQ(out(DANCE_AXES_GLTF, kLeft), Vector3f(1, 0, 0));
  EXPECT_EQ(out(DANCE_AXES_UNITY, kForward), Vector3f(0, 0, 1));
  EXPECT_EQ(out(DANCE_AXES_UNITY, kUp), Vector3f(0, 1, 0));
  EXPECT_EQ(out(DANCE_AXES_UNITY, kLeft), Vector3f(-1, 0, 0));
  EXPECT_EQ(out(DANCE_AXES_UNREAL, kForward), Vector3f(100, 0, 0));
  EXPECT_EQ(out(DANCE_AXES_UNREAL, kUp), Vector3f(0, 0, 100));
  EXPECT_EQ(out(DANCE_AXES_UNREAL, kLeft), Vector3f(0, -100, 0));
  EXPECT_EQ(out(DANCE_AXES_BLENDER, kForward), Vector3f(0, -1, 0));
  EXPECT_EQ(out(DANCE_AXES_BLENDER, kUp), Vector3f(0, 0, 1));
  EXPECT_EQ(out(DANCE_AXES_BLENDER, kLeft), Vector3f(1, 0, 0));
  EXPECT_EQ(find_axes(-1), nullptr);
  EXPECT_EQ(find_axes(4), nullptr);
}

TEST(EngineAxes, UnitysRotationsAreMirroredInX) {
  const Quaternionf q = out(DANCE_AXES_UNITY, Quaternionf(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(q.coeffs(), Eigen::Vector4f(0.2f, -0.3f, -0.4f, 0.1f));
}

TEST(EngineAxes, ATurnedRotationTurnsATurnedPointAsTheRotationTurnsThePoint) {
  Random random(1);
  for (const dance_axes axes : kAll)
    for (int i = 0; i < 100; ++i) {
      const Quaternionf q = random_rotation(random), r = random_rotation(random);
      const Vector3f p = random_direction(random);
      const float scale = find_axes(axes)->scale;
      EXPECT_TRUE((out(axes, q) * out(axes, p)).isApprox(out(axes, Vector3f(q * p)), 1e-5f));
      EXPECT_TRUE(is_same_rotation(out(axes, q) * out(axes, r), out(axes, q * r)));
      EXPECT_NEAR(out(axes, q).norm(), 1.0f, 1e-6f);
      EXPECT_NEAR(out(axes, p).norm(), scale, 1e-5f * scale);
    }
}

TEST(EngineAxes, TheWayBackEndsWhereItBegan) {
  Random random(2);
  for (const dance_axes axes : kAll)
    for (int i = 0; i < 100; ++i) {
      const Quaternionf q = random_rotation(random), there = out(axes, q);
      const Vector3f p = random_direction(random), place = out(axes, p);
      Quaternionf back;
      Vector3f home;
      find_axes(axes)->rotations_in(there.coeffs().data(), back.coeffs().data(), 1);
      find_axes(axes)->point_in(place.data(), home.data());
      EXPECT_EQ(back.coeffs(), q.coeffs());
      EXPECT_TRUE(home.isApprox(p, 1e-6f));
    }
}

TEST(EngineAxes, GltfAndUnityAreTheirOwnInverse) {
  Random random(3);
  for (const dance_axes axes : {DANCE_AXES_GLTF, DANCE_AXES_UNITY})
    for (int i = 0; i < 100; ++i) {
      const Quaternionf q = random_rotation(random);
      EXPECT_EQ(out(axes, out(axes, q)).coeffs(), q.coeffs());
      const Vector3f p = random_direction(random);
      EXPECT_EQ(out(axes, out(axes, p)), p);
    }
}

}  // namespace
}  // namespace dance::engine
