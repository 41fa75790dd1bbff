#include "viewer/view/view_director.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/pose/kinematics.h"
#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kHalfTurn_rad = std::numbers::pi_v<float>;
constexpr ViewDirector::Size kViewSize{960, 540, 100};
constexpr Duration kViewFrame = Duration::us(16'667);
const MonoTime kViewStart = MonoTime::from_us(1'000'000);

SceneState alone(const Vector3f& place, float yaw_rad) {
  SceneState scene;
  scene.guests.push_back(guest_at_ease("alice", place, yaw_rad));
  return scene;
}

Vector3f hand_W_m(const SceneGuest& guest, Bone hand) {
  BodyFrames frames;
  forward_kinematics(guest.skeleton, guest.pose, frames);
  return frames.position(hand);
}

// From the camera's place on the floor, seen from the dancer, as an angle to where it faces.
float side_rad(const ViewDirector& director, const SceneGuest& guest) {
  const Vector3f to_eye = director.camera().eye_W_m() - guest.pose.p_WH_m;
  const Vector3f facing = facing_W(guest);
  return std::remainder(std::atan2(to_eye.x(), to_eye.z()) - std::atan2(facing.x(), facing.z()),
                        2.0f * kHalfTurn_rad);
}

TEST(FollowView, KeepsItsSideOfADancerWhoWalksAndTurns) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFollow);
  SceneState scene = alone(Vector3f::Zero(), 0.0f);
  director.update(scene, kViewSize, Duration());
  const float side = side_rad(director, scene.guests[0]);
  EXPECT_GT(std::abs(side), 0.6f * kHalfTurn_rad) << "behind";
  // Walks five metres and turns a quarter, then stands for five seconds.
  for (int i = 0; i <= 600; ++i) {
    const float share = std::min(1.0f, static_cast<float>(i) / 300.0f);
    scene = alone(Vector3f(5.0f * share, 0.0f, 0.0f), 0.5f * kHalfTurn_rad * share);
    director.update(scene, kViewSize, kViewFrame);
    const auto seen = project(director.camera(), scene.guests[0].pose.p_WH_m, 960.0f, 540.0f);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x_px, 480.0f, 220.0f);
  }
  EXPECT_NEAR(side_rad(director, scene.guests[0]), side, 0.08f);
}

TEST(FollowView, LetsASpinGoBy) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFollow);
  SceneState scene = alone(Vector3f::Zero(), 0.0f);
  director.update(scene, kViewSize, Duration());
  const float yaw = director.camera().yaw_rad;
  for (int i = 0; i <= 40; ++i) {  // a turn in two thirds of a second
    scene = alone(Vector3f::Zero(), 2.0f * kHalfTurn_rad * static_cast<float>(i) / 40.0f);
    director.update(scene, kViewSize, kViewFrame);
    EXPECT_LT(std::abs(std::remainder(director.camera().yaw_rad - yaw, 2.0f * kHalfTurn_rad)),
              0.5f);
  }
}

TEST(FollowView, MovesWithoutJumps) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFollow);
  SceneState scene = alone(Vector3f::Zero(), 0.0f);
  director.update(scene, kViewSize, Duration());
  Vector3f eye = director.camera().eye_W_m();
  for (int i = 1; i < 300; ++i) {
    const float t = static_cast<float>(i) / 60.0f;
    scene = alone(Vector3f(std::sin(2.0f * t), 0.0f, 0.3f * t), std::sin(3.0f * t));
    director.update(scene, kViewSize, kViewFrame);
    EXPECT_LT((director.camera().eye_W_m() - eye).norm(), 0.12f) << "at " << t << " s";
    eye = director.camera().eye_W_m();
  }
}

TEST(MirrorView, ShowsTheLeftHandOnTheLeft) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  SceneState scene = alone(Vector3f(1.0f, 0.0f, 2.0f), 0.7f);
  director.jump(scene, kViewSize);
  ASSERT_TRUE(director.camera().is_mirrored);
  const auto left =
      project(director.camera(), hand_W_m(scene.guests[0], Bone::kLeftHand), 960, 540);
  const auto right =
      project(director.camera(), hand_W_m(scene.guests[0], Bone::kRightHand), 960, 540);
  ASSERT_TRUE(left && right);
  EXPECT_LT(left->x_px, right->x_px - 40.0f);
}

TEST(MirrorView, APartnerInFrontOfTheDancerIsTransparentAndOneAsideIsNot) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  director.choose(*GuestId::parse("alice"));
  const auto opacity_at = [&](const Vector3f& place) {
    SceneState scene = alone(Vector3f::Zero(), 0.0f);
    scene.guests.push_back(guest_at_ease("bob", place, kHalfTurn_rad));
    director.update(scene, kViewSize, kViewFrame);
    EXPECT_EQ(scene.guests[0].opacity, 1.0f);
    return scene.guests[1].opacity;
  };
  EXPECT_LT(opacity_at(Vector3f(0.0f, 0.0f, 0.5f)), 0.3f) << "faces alice, before the mirror";
  EXPECT_EQ(opacity_at(Vector3f(1.3f, 0.0f, 0.5f)), 1.0f);
  EXPECT_EQ(opacity_at(Vector3f(0.0f, 0.0f, -0.6f)), 1.0f) << "behind alice";
}

TEST(MirrorView, TheWholeDancerStandsAboveThePanelAtTheBottom) {
  for (const ViewMode mode : {ViewMode::kMirror, ViewMode::kFollow}) {
    ViewDirector director(CameraPreset::kAuto, mode);
    SceneState scene = alone(Vector3f::Zero(), 0.0f);
    ViewDirector::Size size = kViewSize;
    size.covered_px = 160;
    director.update(scene, size, kViewFrame);
    BodyFrames frames;
    forward_kinematics(scene.guests[0].skeleton, scene.guests[0].pose, frames);
    for (const Tip tip : {Tip::kLeftToes, Tip::kRightToes, Tip::kHead}) {
      const auto at = project(director.camera(), frames.tip(tip), 960.0f, 540.0f);
      ASSERT_TRUE(at);
      EXPECT_GT(at->y_px, 0.0f);
      EXPECT_LT(at->y_px, 540.0f - 160.0f);
    }
  }
}

TEST(ViewDirector, ZoomingInShowsFaces) {
  for (const ViewMode mode : {ViewMode::kOrbit, ViewMode::kMirror, ViewMode::kFollow}) {
    ViewDirector director(CameraPreset::kFront, mode);
    SceneState scene = alone(Vector3f::Zero(), 0.0f);
    director.update(scene, kViewSize, kViewFrame);
    for (int i = 0; i < 20; ++i) director.zoom(1.0f);
    for (int i = 0; i < 400; ++i) director.update(scene, kViewSize, kViewFrame);
    const auto face = project(director.camera(), face_W_m(scene.guests[0]), 960.0f, 540.0f);
    ASSERT_TRUE(face);
    EXPECT_NEAR(face->y_px, 270.0f, 150.0f) << static_cast<int>(mode);
    EXPECT_NEAR(face->x_px, 480.0f, 150.0f);
  }
}

TEST(MirrorView, HangsStillWhileTheDancerTurns) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kMirror);
  SceneState scene = alone(Vector3f::Zero(), 0.0f);
  director.update(scene, kViewSize, Duration());
  const float yaw = director.camera().yaw_rad;
  for (int i = 0; i < 200; ++i) {
    scene = alone(Vector3f::Zero(), 0.5f * kHalfTurn_rad);
    director.update(scene, kViewSize, kViewFrame);
  }
  EXPECT_EQ(director.camera().yaw_rad, yaw);
}

TEST(FirstPersonView, StandsBetweenTheEyesLooksForwardAndHidesThatHeadOnly) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFirstPerson);
  SceneState scene = couple();
  director.choose(scene.guests[1].id);
  director.update(scene, kViewSize, Duration());
  EXPECT_TRUE(scene.guests[1].hides_head);
  EXPECT_FALSE(scene.guests[0].hides_head);
  const Vector3f eye = director.camera().eye_W_m();
  BodyFrames frames;
  forward_kinematics(scene.guests[1].skeleton, scene.guests[1].pose, frames);
  EXPECT_LT((eye - frames.position(Bone::kHead)).norm(), 0.25f);
  EXPECT_GT(eye.y(), frames.position(Bone::kHead).y());
  // Partners face each other.
  const auto partner =
      project(director.camera(), tag_anchor_W_m(scene.guests[0]) - Vector3f(0, 0.2f, 0), 960, 540);
  ASSERT_TRUE(partner);
  EXPECT_NEAR(partner->x_px, 480.0f, 300.0f);
}

TEST(FirstPersonView, DoesNotRoll) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kFirstPerson);
  SceneState scene = alone(Vector3f::Zero(), 0.3f);
  scene.guests[0].pose.R_PB[index_of(Bone::kHead)] = Eigen::AngleAxisf(0.5f, Vector3f::UnitZ());
  director.update(scene, kViewSize, Duration());
  EXPECT_NEAR(director.camera().axes_W().col(0).y(), 0.0f, 1e-5f);
}

TEST(CompareView, ShowsWhatCameBesideWhatIsStagedOfTheSameGuests) {
  ViewDirector director(CameraPreset::kAuto, ViewMode::kCompare);
  SceneState scene = couple();
  director.update(scene, kViewSize, Duration());
  EXPECT_FALSE(director.comparison());
  EXPECT_NE(director.words().find("nothing to compare"), std::string::npos);
  scene.guests[0].arriving = scene.guests[0].pose;
  scene.guests[0].staged = scene.guests[0].pose;
  scene.guests[0].staged->p_WH_m.x() += 0.3f;
  director.update(scene, kViewSize, kViewFrame);
  ASSERT_TRUE(director.comparison());
  const Comparison& both = *director.comparison();
  ASSERT_EQ(both.raw.guests.size(), 2u);
  ASSERT_EQ(both.shown.guests.size(), 2u);
  EXPECT_NEAR(both.shown.guests[0].pose.p_WH_m.x() - both.raw.guests[0].pose.p_WH_m.x(), 0.3f,
              1e-6f);
  EXPECT_EQ(both.shown.guests[1].pose.p_WH_m, both.raw.guests[1].pose.p_WH_m);
  EXPECT_NE(both.raw.stage, both.shown.stage);
}

TEST(GridView, GivesEachCoupleAndEachSingleDancerACellWithThemInIt) {
  SceneState scene;
  scene.time = kViewStart;
  for (int i = 0; i < 3; ++i) {
    const auto x = static_cast<float>(5 * i);
    scene.guests.push_back(guest_at_ease(("a" + std::to_string(i)).c_str(), {x, 0, 0}, 0.0f));
    if (i < 2)
      scene.guests.push_back(guest_at_ease(("b" + std::to_string(i)).c_str(), {x + 0.8f, 0, 0}, 0));
  }
  ViewDirector director(CameraPreset::kAuto, ViewMode::kGrid);
  director.choose(*GuestId::parse("b1"));
  director.jump(scene, kViewSize);
  ASSERT_EQ(director.cells().size(), 3u);
  EXPECT_EQ(director.cells()[0].scene->guests.size(), 2u);
  EXPECT_EQ(director.cells()[2].scene->guests.size(), 1u);
  EXPECT_FALSE(director.cells()[0].is_chosen);
  EXPECT_TRUE(director.cells()[1].is_chosen);
  for (const StageCell& cell : director.cells()) {
    EXPECT_GE(cell.box.left_px, 0);
    EXPECT_LE(cell.box.left_px + cell.box.width_px, kViewSize.width_px);
    EXPECT_LE(cell.box.top_px + cell.box.height_px, kViewSize.height_px);
    const auto width = static_cast<float>(cell.box.width_px);
    const auto height = static_cast<float>(cell.box.height_px);
    for (const SceneGuest& guest : cell.scene->guests) {
      std::vector<Vector3f> points;
      append_outline(guest, points);
      for (const Vector3f& point : points) {
        const auto seen = project(cell.camera, point, width, height);
        ASSERT_TRUE(seen);
        EXPECT_GE(seen->x_px, 0.0f);
        EXPECT_LE(seen->x_px, width);
        EXPECT_GE(seen->y_px, 0.0f);
        EXPECT_LE(seen->y_px, height);
      }
    }
  }
}

TEST(GridView, CellsDoNotOverlapForAnyNumberOfGuests) {
  for (std::size_t n = 1; n <= 64; ++n) {
    const std::vector<PixelBox> boxes = grid_boxes(n, 1280, 720);
    ASSERT_EQ(boxes.size(), n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = i + 1; k < n; ++k) {
        const PixelBox& a = boxes[i];
        const PixelBox& b = boxes[k];
        EXPECT_TRUE(a.left_px + a.width_px <= b.left_px || b.left_px + b.width_px <= a.left_px ||
                    a.top_px + a.height_px <= b.top_px || b.top_px + b.height_px <= a.top_px)
            << n << " cells, " << i << " and " << k;
      }
  }
}

TEST(ViewCoupleFinder, KeepsACoupleThatStepsApartAndPartsItInTheEnd) {
  ViewCoupleFinder couples;
  SceneState scene;
  const auto at = [&](float apart_m, Duration t) {
    scene.time = kViewStart + t;
    scene.guests.clear();
    scene.guests.push_back(guest_at_ease("a", Vector3f::Zero(), 0));
    scene.guests.push_back(guest_at_ease("b", {apart_m, 0, 0}, 0));
    return couples.groups(scene).size();
  };
  EXPECT_EQ(at(0.8f, Duration()), 1u);
  EXPECT_EQ(at(1.9f, Duration::s(1)), 1u) << "an open position";
  EXPECT_EQ(at(3.0f, Duration::s(2)), 1u) << "a moment";
  EXPECT_EQ(at(3.0f, Duration::s(5)), 2u);
  EXPECT_EQ(at(1.9f, Duration::s(6)), 2u) << "not yet together again";
}

TEST(ViewDirector, GoesRoundTheDancersAndTheViews) {
  ViewDirector director(CameraPreset::kAuto);
  SceneState scene = couple();
  director.choose_next(scene, 1);
  EXPECT_EQ(director.chosen(), scene.guests[0].id);
  director.choose_next(scene, 1);
  EXPECT_EQ(director.chosen(), scene.guests[1].id);
  director.choose_next(scene, 1);
  EXPECT_EQ(director.chosen(), scene.guests[0].id);
  director.choose_next(scene, -1);
  EXPECT_EQ(director.chosen(), scene.guests[1].id);
  for (const ViewName& name : kViewNames) {
    EXPECT_EQ(director.mode(), name.mode);
    EXPECT_EQ(&name_of(name.mode), &name);
    director.update(scene, kViewSize, kViewFrame);
    EXPECT_FALSE(director.cells().empty() && !director.comparison());
    director.show_next(1);
  }
  EXPECT_EQ(director.mode(), ViewMode::kOrbit);
  SceneState empty;
  director.choose_next(empty, 1);
  for (const ViewName& name : kViewNames) {
    director.show(name.mode);
    director.update(empty, kViewSize, kViewFrame);
    EXPECT_EQ(director.cells().size(), 1u) << name.option;
  }
}

}  // namespace
}  // namespace dance
