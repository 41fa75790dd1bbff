#include "viewer/view/camera_rig.h"

#include <gtest/gtest.h>

#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

constexpr float kAspect = 16.0f / 9.0f;
constexpr Duration kFrame = Duration::ms(16);

float height_in_picture(const CameraRig& rig, const SceneGuest& guest) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  const auto head = project(rig.camera(), frames.tip(Tip::kHead), kAspect, 1.0f);
  const auto foot = project(rig.camera(), frames.position(Bone::kLeftFoot), kAspect, 1.0f);
  return head && foot ? foot->y_px - head->y_px : 0.0f;
}

TEST(CameraRig, FramesAtOnceWhoComesFirst) {
  CameraRig rig(CameraPreset::kAuto);
  const SceneState scene = couple();
  rig.update(scene, kAspect, kFrame);
  EXPECT_GT(height_in_picture(rig, scene.guests[0]), 0.55f);
}

TEST(CameraRig, FramesAGuestWhoJoinsWithoutAJump) {
  CameraRig rig(CameraPreset::kFront);
  SceneState scene = couple();
  rig.update(scene, kAspect, kFrame);
  const float before = rig.camera().distance_m;
  scene.guests.push_back(guest_at_ease("carla", Eigen::Vector3f(5.0f, 0.0f, 0.0f), 0.0f));
  rig.update(scene, kAspect, kFrame);
  EXPECT_LT(rig.camera().distance_m, 1.1f * before) << "no jump in one frame";
  for (int i = 0; i < 600; ++i) rig.update(scene, kAspect, kFrame);
  for (const SceneGuest& guest : scene.guests) {
    const auto at = project(rig.camera(), guest.pose.p_WH_m, kAspect, 1.0f);
    ASSERT_TRUE(at);
    EXPECT_GT(at->x_px, 0.0f);
    EXPECT_LT(at->x_px, kAspect);
  }
}

TEST(CameraRig, FocusesOneGuestAndComesBackToAll) {
  CameraRig rig(CameraPreset::kFront);
  SceneState scene = full_floor();
  rig.update(scene, kAspect, kFrame);
  const float all = rig.camera().distance_m;
  rig.focus(scene.guests[3].id);
  for (int i = 0; i < 900; ++i) rig.update(scene, kAspect, kFrame);
  EXPECT_LT(rig.camera().distance_m, 0.75f * all);
  EXPECT_NEAR(rig.camera().target_W_m.x(), scene.guests[3].pose.p_WH_m.x(), 0.1f);
  rig.frame_all();
  for (int i = 0; i < 900; ++i) rig.update(scene, kAspect, kFrame);
  EXPECT_NEAR(rig.camera().distance_m, all, 0.05f * all);
}

TEST(CameraRig, StaysWhereItWasPannedTo) {
  CameraRig rig(CameraPreset::kFront);
  const SceneState scene = couple();
  rig.update(scene, kAspect, kFrame);
  rig.drag_pan(0.3f, 0.0f);
  const Eigen::Vector3f target = rig.camera().target_W_m;
  for (int i = 0; i < 100; ++i) rig.update(scene, kAspect, kFrame);
  EXPECT_EQ(rig.camera().target_W_m, target);
}

TEST(CameraRig, NeverLooksFromUnderTheFloor) {
  CameraRig rig(CameraPreset::kFront);
  for (int i = 0; i < 50; ++i) rig.drag_orbit(0.0f, 1.0f);
  EXPECT_GT(rig.camera().pitch_rad, -0.1f);
  for (int i = 0; i < 50; ++i) rig.drag_orbit(0.0f, -1.0f);
  EXPECT_LT(rig.camera().pitch_rad, 1.5708f);
}

TEST(CameraRig, StopsTurningWhenSomebodyDrags) {
  CameraRig rig(CameraPreset::kOrbit);
  const SceneState scene = couple();
  rig.set_turning(true);
  const float before = rig.camera().yaw_rad;
  for (int i = 0; i < 60; ++i) rig.update(scene, kAspect, kFrame);
  EXPECT_GT(rig.camera().yaw_rad, before);
  rig.drag_orbit(0.1f, 0.0f);
  const float after = rig.camera().yaw_rad;
  rig.update(scene, kAspect, kFrame);
  EXPECT_EQ(rig.camera().yaw_rad, after);
}

TEST(CameraRig, GivesSeveralMomentsOneFrame) {
  CameraRig rig(CameraPreset::kAuto);
  const SceneState first = couple();
  SceneState second = couple();
  for (SceneGuest& guest : second.guests) guest.pose.p_WH_m.x() += 2.0f;
  rig.jump({&first, &second}, kAspect);
  for (const SceneState* scene : std::initializer_list<const SceneState*>{&first, &second})
    for (const SceneGuest& guest : scene->guests) {
      const auto at = project(rig.camera(), guest.pose.p_WH_m, kAspect, 1.0f);
      ASSERT_TRUE(at);
      EXPECT_GT(at->x_px, 0.0f);
      EXPECT_LT(at->x_px, kAspect);
    }
}

}  // namespace
}  // namespace dance
