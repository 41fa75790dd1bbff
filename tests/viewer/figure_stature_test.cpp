// Where cameras take a figure to be, against where it is posed.
#include "viewer/scene/figure_stature.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/allocation_guard.h"
#include "tests/viewer/figure/test_rigs.h"
#include "tests/viewer/test_scene.h"
#include "viewer/view/view_director.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr ViewDirector::Size kFramePeriod{960, 540, 100};

struct Worn {
  float avatar_m;  // how tall the avatar's file is
  FigureSize size;
  float height_scale;
};
constexpr std::array<Worn, 6> kWorn{{{1.72f, FigureSize::kDancers, 2.0f},
                                     {1.3f, FigureSize::kDancers, 2.0f},
                                     {1.3f, FigureSize::kOwn, 1.0f},
                                     {2.1f, FigureSize::kOwn, 1.5f},
                                     {1.9f, FigureSize::kOwn, 0.5f},
                                     {1.72f, FigureSize::kDancers, 1.0f}}};

// The couple of the tests, she in that figure.
SceneState couple_with(const Worn& worn) {
  static std::map<float, std::shared_ptr<const AvatarModel>> models;  // each takes a while to make
  auto& model = models[worn.avatar_m];
  if (!model)
    model = std::make_shared<AvatarModel>(
        with_other_axes(mannequin_of(average_skeleton(worn.avatar_m)), 7, 0.01f));
  SceneState scene = couple();
  scene.time = MonoTime::from_us(1'000'000);
  SceneGuest& alice = scene.guests[0];
  alice.avatar = model;
  alice.figure_size = worn.size;
  alice.height_scale = worn.height_scale;
  return scene;
}

BodyFrames posed(FigurePoser& poser, const SceneState& scene) {
  const auto figures = poser.pose(scene);
  EXPECT_EQ(figures.size(), 1u);
  return figures[0].frames;
}

TEST(FigureStature, IsThatOfThePosedFigure) {
  for (const Worn& worn : kWorn) {
    const SceneState scene = couple_with(worn);
    FigurePoser poser;
    const BodyFrames figure = posed(poser, scene);
    BodyFrames guessed;
    figure_frames(scene.guests[0], guessed);
    const float large = figure_height_m(scene.guests[0]) / 1.72f;
    // Feet come to where the dancer steps, and hands to where hands meet.
    for (const Bone bone : {Bone::kHips, Bone::kChest, Bone::kHead})
      EXPECT_LT((guessed.position(bone) - figure.position(bone)).norm(), 0.06f * large)
          << worn.avatar_m << " m, bone " << index_of(bone);
  }
}

TEST(FigureStature, IsTheDancersWithoutAnAvatar) {
  const SceneState scene = couple();
  const FigureStature stature = stature_of(scene.guests[0]);
  EXPECT_EQ(stature.legs, 1.0f);
  EXPECT_EQ(stature.body, 1.0f);
  EXPECT_NEAR(figure_height_m(scene.guests[0]), standing_height_m(scene.guests[0].skeleton), 1e-5f);
}

TEST(FigureStature, TakesAModelThatCannotBeMeasuredAsTheDancer) {
  SceneState scene = couple_with(kWorn[2]);
  AvatarModel flat = *scene.guests[0].avatar;
  for (AvatarNode& node : flat.nodes) node.translation_m.setZero();
  scene.guests[0].avatar = std::make_shared<AvatarModel>(flat);
  scene.guests[0].height_scale = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(figure_height_m(scene.guests[0]), standing_height_m(scene.guests[0].skeleton), 1e-5f);
}

TEST(FigureStature, AllocatesNothing) {
  const SceneState scene = couple_with(kWorn[0]);
  const AllocationGuard guard;
  EXPECT_GT(figure_eyes_W_m(scene.guests[0]).y(), 2.5f);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(FigureStature, TheWholeFigureIsInThePictureOfEveryViewThatShowsIt) {
  for (const Worn& worn : kWorn)
    for (const ViewMode mode :
         {ViewMode::kOrbit, ViewMode::kFollow, ViewMode::kMirror, ViewMode::kGrid}) {
      SceneState scene = couple_with(worn);
      FigurePoser poser;
      const BodyFrames figure = posed(poser, scene);
      ViewDirector director(CameraPreset::kAuto, mode);
      director.choose(scene.guests[0].id);
      director.jump(scene, kFramePeriod);
      const StageCell& cell = director.cells()[0];
      const auto width = static_cast<float>(cell.box.width_px);
      const auto height = static_cast<float>(cell.box.height_px);
      std::vector<Vector3f> points(figure.p_WB_m.begin(), figure.p_WB_m.end());
      points.insert(points.end(), figure.p_WT_m.begin(), figure.p_WT_m.end());
      for (const Vector3f& point : points) {
        const auto seen = project(cell.camera, point, width, height);
        ASSERT_TRUE(seen);
        EXPECT_GE(seen->x_px, 0.0f) << name_of(mode).option << ", " << worn.avatar_m;
        EXPECT_LE(seen->x_px, width) << name_of(mode).option << ", " << worn.avatar_m;
        EXPECT_GE(seen->y_px, 0.0f) << name_of(mode).option << ", " << worn.avatar_m;
        EXPECT_LE(seen->y_px, height) << name_of(mode).option << ", " << worn.avatar_m;
      }
    }
}

TEST(FirstPersonView, StandsAtTheHeadOfTheFigure) {
  for (const Worn& worn : kWorn) {
    SceneState scene = couple_with(worn);
    FigurePoser poser;
    const BodyFrames figure = posed(poser, scene);
    ViewDirector director(CameraPreset::kAuto, ViewMode::kFirstPerson);
    director.choose(scene.guests[0].id);
    director.jump(scene, kFramePeriod);
    const float large = figure_height_m(scene.guests[0]) / 1.72f;
    const Vector3f from_head = director.camera().eye_W_m() - figure.position(Bone::kHead);
    EXPECT_LT(from_head.norm(), 0.25f * large) << worn.avatar_m;
    EXPECT_GT(from_head.y(), 0.0f) << worn.avatar_m;
  }
}

TEST(FirstPersonView, StandsAtTheEyesThatTheModelHas) {
  SceneState scene = couple_with(kWorn[0]);
  AvatarModel model = mannequin_of(average_skeleton(1.72f));
  const int head = model.node_of(Bone::kHead);
  for (std::size_t side = 0; side < 2; ++side) {
    model.eyes[side] = static_cast<int>(model.nodes.size());
    model.nodes.push_back({"eye", head, Vector3f(side == 0 ? 0.03f : -0.03f, 0.07f, 0.09f)});
  }
  scene.guests[0].avatar = std::make_shared<AvatarModel>(model);
  BodyFrames frames;
  figure_frames(scene.guests[0], frames);
  const float scale = stature_of(scene.guests[0]).scale;
  const Vector3f eyes = frames.position(Bone::kHead) +
                        frames.R_WB[index_of(Bone::kHead)] * Vector3f(0.0f, 0.07f, 0.09f) * scale;
  EXPECT_LT((figure_eyes_W_m(scene.guests[0]) - eyes).norm(), 1e-3f);
}

}  // namespace
}  // namespace dance
