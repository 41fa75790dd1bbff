// Rigs of other axes, stances and names do what the mannequin does.
#include <gtest/gtest.h>

#include "tests/viewer/figure/test_rigs.h"

namespace dance {
namespace {

using Eigen::Vector3f;

SceneState scene_of(std::initializer_list<SceneGuest> guests) {
  SceneState scene;
  scene.time = MonoTime::from_us(5'000'000);
  scene.guests = guests;
  return scene;
}

void expect_alike(const PosedFigure& a, const PosedFigure& b, float most_m) {
  ASSERT_EQ(a.model->vertices.size(), b.model->vertices.size());
  float worst = 0.0f;
  for (std::size_t v = 0; v < a.model->vertices.size(); v += 7)
    worst = std::max(worst, (place_of(a, v) - place_of(b, v)).norm());
  EXPECT_LT(worst, most_m);
}

TEST(FigureRigs, TheOwnMannequinHasEachJointWhereTheDancerHasIt) {
  Random random(3);
  const Skeleton skeleton = average_skeleton(1.64f);
  FigurePoser poser;
  const auto mannequin = shared(mannequin_of(skeleton));
  for (int i = 0; i < 40; ++i) {
    SceneGuest guest = guest_in(mannequin);
    guest.skeleton = skeleton;
    guest.pose =
        random_pose(random, i == 0 ? 0.0f : 1.5f, i == 0 ? skeleton.hips_height_m() : 3.0f);
    BodyFrames danced;
    forward_kinematics(skeleton, guest.pose, danced);
    const auto figures = poser.pose(scene_of({guest}));
    ASSERT_EQ(figures.size(), 1u);
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      // Hands of one dancer that touch stay where they are too.
      EXPECT_LT((figures[0].frames.p_WB_m[b] - danced.p_WB_m[b]).norm(), 1e-3f) << kBones[b].name;
      const Vector3f in_mesh = guest.avatar->joints[b].node_from_mesh.inverse().translation();
      EXPECT_LT((figures[0].W_from_joint[b] * in_mesh.homogeneous() - danced.p_WB_m[b]).norm(),
                1e-3f)
          << kBones[b].name;
    }
  }
}

TEST(FigureRigs, AxesAndUnitsOfTheFileDoNotMatter) {
  Random random(4);
  const auto plain = shared(mannequin_of(average_skeleton(1.9f)));
  for (const float unit : {1.0f, 0.01f, 2.5f}) {
    const auto other = shared(with_other_axes(*plain, 11, unit));
    ASSERT_TRUE(is_sound(*other));
    FigurePoser one, two;
    for (int i = 0; i < 12; ++i) {
      SceneGuest a = guest_in(plain), b = guest_in(other);
      a.pose = b.pose = random_pose(random, 0.9f, 1.0f);
      expect_alike(one.pose(scene_of({a}))[0], two.pose(scene_of({b}))[0], 2e-3f);
    }
  }
}

TEST(FigureRigs, AnAPoseDancesAsATPose) {
  Random random(5);
  const auto t_pose = shared(mannequin_of(average_skeleton(1.6f)));
  const auto a_pose = shared(with_other_axes(in_a_pose(*t_pose, 45.0f), 12, 1.0f));
  FigurePoser one, two;
  for (int i = 0; i < 12; ++i) {
    SceneGuest a = guest_in(t_pose), b = guest_in(a_pose);
    a.pose = b.pose = random_pose(random, 0.6f, 3.0f);  // in the air
    const auto straight = one.pose(scene_of({a}));
    const auto hanging = two.pose(scene_of({b}));
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      EXPECT_LT((straight[0].frames.p_WB_m[bone] - hanging[0].frames.p_WB_m[bone]).norm(), 0.012f)
          << kBones[bone].name;
    expect_alike(straight[0], hanging[0], 0.035f);  // of the feet's turn at rest
  }
}

TEST(FigureRigs, TurnsOfBonesThatAreMissingGoToTheirNeighbours) {
  const auto whole = shared(mannequin_of(average_skeleton(1.7f)));
  const auto sparse =
      shared(without(*whole, {Bone::kSpine, Bone::kUpperChest, Bone::kNeck, Bone::kLeftShoulder,
                              Bone::kRightShoulder, Bone::kLeftToes, Bone::kRightToes}));
  FigurePoser one, two;
  SceneGuest a = guest_in(whole), b = guest_in(sparse);
  for (const Bone bone : {Bone::kSpine, Bone::kUpperChest, Bone::kNeck})
    a.pose.R_PB[index_of(bone)] = exp_rotation(Vector3f(0.1f, 0.3f, 0.0f));
  a.pose.p_WH_m.y() = 2.0f;
  b.pose = a.pose;
  const BodyFrames full = one.pose(scene_of({a}))[0].frames;
  const BodyFrames folded = two.pose(scene_of({b}))[0].frames;
  for (const Bone bone : {Bone::kHead, Bone::kLeftHand, Bone::kRightHand, Bone::kLeftFoot})
    EXPECT_LT(full.R_WB[index_of(bone)].angularDistance(folded.R_WB[index_of(bone)]), 0.02f)
        << kBones[index_of(bone)].name;
  // None of them at all: head and arms have all of it.
  const auto stiff = shared(without(*sparse, {Bone::kChest}));
  SceneGuest c = guest_in(stiff);
  c.pose = a.pose;
  FigurePoser three;
  EXPECT_LT(three.pose(scene_of({c}))[0].frames.R_WB[index_of(Bone::kHead)].angularDistance(
                full.R_WB[index_of(Bone::kHead)]),
            0.02f);
}

TEST(FigureRigs, WhateverIsDancedIsFiniteAndTurnsAreUnit) {
  Random random(6);
  const auto model = mannequin_of(average_skeleton(1.1f));
  const std::vector<std::shared_ptr<const AvatarModel>> avatars{
      shared(with_other_axes(in_a_pose(model, 50.0f), 13, 0.01f)),
      shared(mannequin_of(average_skeleton(2.2f))),
      shared(without(model, {Bone::kSpine, Bone::kChest, Bone::kUpperChest, Bone::kNeck,
                             Bone::kLeftShoulder, Bone::kRightToes}))};
  FigurePoser poser;
  for (int i = 0; i < 200; ++i) {
    SceneState scene = scene_of({});
    scene.time = MonoTime::from_us(1'000'000 + 16'000 * i);
    for (std::size_t g = 0; g < avatars.size(); ++g) {
      SceneGuest guest = guest_in(avatars[g], g == 0 ? "a" : g == 1 ? "b" : "c");
      guest.pose = random_pose(random, 3.1f, static_cast<float>(random.uniform() * 3.0 - 1.0));
      guest.figure_size = i % 2 == 0 ? FigureSize::kDancers : FigureSize::kOwn;
      guest.height_scale = i % 3 == 0 ? 0.25f : i % 3 == 1 ? 1.0f : 4.0f;
      if (i % 5 == 0) guest.pose.p_WH_m *= 300.0f;
      ASSERT_TRUE(is_valid(guest.pose));
      scene.guests.push_back(guest);
    }
    for (const PosedFigure& figure : poser.pose(scene)) {
      for (const JointMatrix& matrix : figure.W_from_joint) ASSERT_TRUE(matrix.allFinite()) << i;
      for (const auto& R : figure.frames.R_WB) ASSERT_NEAR(R.norm(), 1.0f, 1e-4f);
      for (const auto& p : figure.frames.p_WB_m) ASSERT_TRUE(p.allFinite());
    }
  }
}

TEST(FigureRigs, AnAvatarIsAsLargeAsItsDancersLegsOrItsOwnSize) {
  const auto giant = shared(mannequin_of(average_skeleton(2.2f)));
  FigurePoser poser;
  const auto height = [&](FigureSize size, float scale) {
    SceneGuest guest = guest_in(giant);  // the dancer is 1.72 m
    guest.figure_size = size;
    guest.height_scale = scale;
    const PosedFigure& figure = poser.pose(scene_of({guest}))[0];
    return figure.frames.tip(Tip::kHead).y();
  };
  EXPECT_NEAR(height(FigureSize::kDancers, 1.0f), 1.72f, 0.06f);
  EXPECT_NEAR(height(FigureSize::kOwn, 1.0f), 2.2f, 0.08f);
  EXPECT_NEAR(height(FigureSize::kDancers, 0.5f), 0.86f, 0.04f);
  EXPECT_NEAR(height(FigureSize::kDancers, 1000.0f), 4.0f * 1.72f, 0.3f);  // bounded
}

TEST(FigureRigs, TheTipOfTheHeadIsTheTopOfItHoweverLargeTheHeadIs) {
  AvatarModel big_head = mannequin_of(average_skeleton(1.7f));
  const Vector3f head =
      big_head.joints[index_of(Bone::kHead)].node_from_mesh.inverse().translation();
  for (AvatarVertex& vertex : big_head.vertices)
    for (std::size_t k = 0; k < 4; ++k)
      if (vertex.joints[k] == index_of(Bone::kHead) && vertex.weights[k] > 127) {
        vertex.place_m = head + 3.0f * (vertex.place_m - head);
        break;
      }
  for (const AvatarModel& model : {big_head, mannequin_of(average_skeleton(1.7f))}) {
    FigurePoser poser;
    const auto figures = poser.pose(scene_of({guest_in(shared(model))}));
    float top_m = 0.0f;
    for (std::size_t v = 0; v < model.vertices.size(); ++v)
      top_m = std::max(top_m, place_of(figures[0], v).y());
    EXPECT_NEAR(figures[0].frames.tip(Tip::kHead).y(), top_m, 0.01f);
  }
}

}  // namespace
}  // namespace dance
