// Hair and cloth swing, stay bounded, and do so alike at any rate of pictures; eyes blink.
#include <gtest/gtest.h>

#include "tests/viewer/figure/test_rigs.h"
#include "viewer/figure/face/blink.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kLink_m = 0.1f;

// A mannequin with a braid of four links down from the back of the head, and a ball in its way.
AvatarModel with_a_braid(bool has_ball) {
  AvatarModel model = mannequin_of(average_skeleton());
  AvatarSpring spring;
  int parent = model.node_of(Bone::kHead);
  for (int i = 0; i < 4; ++i) {
    AvatarNode node;
    node.name = "braid";
    node.parent = parent;
    node.translation_m = i == 0 ? Vector3f(0, 0.1f, -0.12f) : Vector3f(0, -kLink_m, 0);
    parent = static_cast<int>(model.nodes.size());
    model.nodes.push_back(node);
    AvatarJoint joint;
    joint.node = parent;
    model.joints.push_back(joint);
    spring.joints.push_back(
        {parent, Vector3f(0, -kLink_m, 0), 0.02f, 0.4f, 0.2f, -Vector3f::UnitY(), 0.3f});
  }
  if (has_ball) {
    spring.colliders.push_back(0);
    model.colliders.push_back({model.node_of(Bone::kHead), Vector3f(0, -0.05f, -0.2f),
                               Vector3f(0, -0.25f, -0.2f), 0.08f});
  }
  model.springs.push_back(spring);
  model.morphs = {{"eyelids", {0}, {Vector3f::UnitY()}, {}}};
  model.expressions = {{"blink", {{0, 1.0f}}}};
  return model;
}

// The end of the braid, and of each link, after a dance of turns for two seconds.
std::vector<Vector3f> ends_after(const std::shared_ptr<const AvatarModel>& avatar, int hz,
                                 FigurePoser& poser) {
  std::vector<Vector3f> ends;
  for (int i = 0; i <= 2 * hz; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(hz);
    SceneGuest guest = guest_in(avatar);
    guest.pose.R_PB[0] = exp_rotation(Vector3f(0, 2.0f * std::sin(4.0f * t), 0));
    guest.pose.p_WH_m.x() = 0.4f * std::sin(6.0f * t);
    SceneState scene;
    scene.time = MonoTime::from_us(10'000'000) + Duration::seconds(i / static_cast<double>(hz));
    scene.guests = {guest};
    const PosedFigure& figure = poser.pose(scene)[0];
    ends.clear();
    for (std::size_t j = avatar->joints.size() - 4; j < avatar->joints.size(); ++j) {
      const Vector3f from = figure.W_from_joint[j].col(3);
      const Vector3f to = figure.W_from_joint[j] * Vector3f(0, -kLink_m, 0).homogeneous();
      EXPECT_TRUE(to.allFinite());
      EXPECT_NEAR((to - from).norm(), kLink_m, 1e-3f);
      ends.push_back(to);
    }
  }
  return ends;
}

TEST(FigureSprings, ABraidKeepsItsLengthAndSwingsAlikeAtAnyRate) {
  const auto avatar = shared(with_a_braid(false));
  ASSERT_TRUE(is_sound(*avatar));
  FigurePoser slow, usual, fast;
  const auto at_30 = ends_after(avatar, 30, slow), at_60 = ends_after(avatar, 60, usual),
             at_144 = ends_after(avatar, 144, fast);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((at_60[i] - at_144[i]).norm(), 0.03f) << i;
    EXPECT_LT((at_30[i] - at_60[i]).norm(), 0.06f) << i;
  }
}

TEST(FigureSprings, TheyLagBehindATurnAndComeToRestAfterAPause) {
  const auto avatar = shared(with_a_braid(false));
  FigurePoser poser, still;
  const Vector3f swinging = ends_after(avatar, 60, poser).back();
  SceneGuest guest = guest_in(avatar);
  guest.pose.R_PB[0] = exp_rotation(Vector3f(0, 2.0f * std::sin(8.0f), 0));
  guest.pose.p_WH_m.x() = 0.4f * std::sin(12.0f);
  SceneState scene;
  scene.time = MonoTime::from_us(12'000'000);
  scene.guests = {guest};
  const PosedFigure& resting = still.pose(scene)[0];
  const Vector3f at_rest = resting.W_from_joint.back() * Vector3f(0, -kLink_m, 0).homogeneous();
  EXPECT_GT((swinging - at_rest).norm(), 0.02f);
  scene.time += Duration::s(2);  // a pause
  const Vector3f after =
      poser.pose(scene)[0].W_from_joint.back() * Vector3f(0, -kLink_m, 0).homogeneous();
  EXPECT_LT((after - at_rest).norm(), 1e-3f);
  scene.time = MonoTime::from_us(3'000'000);  // and a jump back
  const Vector3f earlier =
      poser.pose(scene)[0].W_from_joint.back() * Vector3f(0, -kLink_m, 0).homogeneous();
  EXPECT_LT((earlier - at_rest).norm(), 1e-3f);
}

TEST(FigureSprings, CollidersAreNotEntered) {
  const auto avatar = shared(with_a_braid(true));
  FigurePoser poser;
  ends_after(avatar, 60, poser);
  // Standing still, the capsule where the braid would hang.
  SceneState scene;
  for (int i = 0; i < 240; ++i) {
    scene.time = MonoTime::from_us(20'000'000 + 16'667 * i);
    scene.guests = {guest_in(avatar)};
    const PosedFigure& figure = poser.pose(scene)[0];
    if (i < 200) continue;
    const Vector3f head = figure.frames.position(Bone::kHead);
    for (std::size_t j = avatar->joints.size() - 4; j < avatar->joints.size(); ++j) {
      const Vector3f end = figure.W_from_joint[j] * Vector3f(0, -kLink_m, 0).homogeneous();
      const Vector3f low = head + Vector3f(0, -0.25f, -0.2f),
                     high = head + Vector3f(0, -0.05f, -0.2f);
      const float y = std::clamp(end.y(), low.y(), high.y());
      EXPECT_GT((end - Vector3f(low.x(), y, low.z())).norm(), 0.08f + 0.02f - 5e-3f);
    }
  }
}

// As a stranger's file may have it: hair of thousands of nodes, each with many colliders.
AvatarModel with_hair_of(std::size_t strands, std::size_t nodes, std::size_t colliders) {
  AvatarModel model = mannequin_of(average_skeleton());
  for (std::size_t c = 0; c < colliders; ++c)
    model.colliders.push_back(
        {model.node_of(Bone::kHead), Vector3f(0, 0.1f, 0), Vector3f(0, 0.1f, 0), 0.01f});
  for (std::size_t s = 0; s < strands; ++s) {
    AvatarSpring spring;
    int parent = model.node_of(Bone::kHead);
    for (std::size_t n = 0; n < nodes; ++n) {
      AvatarNode node;
      node.parent = parent;
      node.translation_m = Vector3f(0, -0.01f, -0.01f);
      parent = static_cast<int>(model.nodes.size());
      model.nodes.push_back(node);
      spring.joints.push_back(
          {parent, Vector3f(0, -0.01f, 0), 0.0f, 0.4f, 0.2f, -Vector3f::UnitY(), 0.3f});
    }
    for (std::size_t c = 0; c < colliders; ++c)
      spring.colliders.push_back(static_cast<std::uint32_t>(c));
    model.springs.push_back(spring);
  }
  return model;
}

std::size_t contacts_of(const AvatarShape& shape) {
  std::size_t contacts = 0;
  for (const SwingNode& node : shape.swings) contacts += node.collider_count;
  return contacts;
}

TEST(FigureSprings, WhatSwingsOfOneFigureIsBoundedHoweverMuchItsFileAsksFor) {
  const AvatarModel model = with_hair_of(100, 40, 200);
  ASSERT_TRUE(is_sound(model));
  const AvatarShape shape = shape_of(model);
  EXPECT_EQ(shape.swings.size(), kMostSpringContacts / kMostSpringColliders);
  EXPECT_EQ(contacts_of(shape), kMostSpringContacts);
  EXPECT_LE(shape.colliders.size(), kMostSpringContacts);
  const AvatarShape free = shape_of(with_hair_of(100, 40, 0));
  EXPECT_EQ(free.swings.size(), kMostSwingingNodes);
  // What an avatar has that is made with care all swings.
  const AvatarShape usual = shape_of(with_hair_of(40, 5, 16));
  EXPECT_EQ(usual.swings.size(), 200u);
  EXPECT_EQ(contacts_of(usual), 3200u);
}

// Where the last link of each of three guests' braids ends after they have turned.
std::array<Vector3f, 3> three_ends(FigureOptions options) {
  const auto avatar = shared(with_a_braid(false));
  FigurePoser poser(options);
  std::array<Vector3f, 3> ends;
  for (int i = 0; i <= 60; ++i) {
    SceneState scene;
    scene.time = MonoTime::from_us(10'000'000 + 16'667 * i);
    for (const char* name : {"alice", "bob", "clara"}) {
      scene.guests.push_back(guest_in(avatar, name));
      scene.guests.back().pose.R_PB[0] =
          exp_rotation(Vector3f(0, 2.0f * std::sin(0.1f * static_cast<float>(i)), 0));
    }
    const auto figures = poser.pose(scene);
    for (std::size_t g = 0; g < 3; ++g)
      ends[g] = figures[g].W_from_joint.back() * Vector3f(0, -kLink_m, 0).homogeneous();
  }
  return ends;
}

TEST(FigureSprings, FiguresBeyondThePicturesBudgetAreAtRestAndTheOthersSwingOn) {
  FigureOptions options;
  const auto all = three_ends(options);
  options.most_spring_work = 0;
  const auto none = three_ends(options);
  options.most_spring_work = 11;  // a braid is four
  const auto some = three_ends(options);
  ASSERT_GT((all[0] - none[0]).norm(), 0.02f);
  EXPECT_EQ(some[0], all[0]);
  EXPECT_EQ(some[1], all[1]);
  EXPECT_EQ(some[2], none[2]);
}

TEST(FigureFace, EyesBlinkEveryFewSecondsAndAreOpenInASinglePicture) {
  const auto avatar = shared(with_a_braid(false));
  FigurePoser poser;
  int blinks = 0;
  float before = 0.0f;
  for (int i = 0; i < 60 * 60; ++i) {
    SceneState scene;
    scene.time = MonoTime::from_us(1'000'000 + 16'667 * i);
    scene.guests = {guest_in(avatar)};
    const float weight = poser.pose(scene)[0].morph_weights[0];
    EXPECT_GE(weight, 0.0f);
    EXPECT_LE(weight, 1.0f);
    blinks += before < 0.5f && weight >= 0.5f;
    before = weight;
    if (weight < 0.9f) continue;
    FigurePoser alone;
    EXPECT_EQ(alone.pose(scene)[0].morph_weights[0], 0.0f);
  }
  EXPECT_GE(blinks, 12);
  EXPECT_LE(blinks, 20);
  const auto a = *GuestId::parse("alice");
  EXPECT_EQ(blink_at(a, MonoTime::from_us(77'123'456)), blink_at(a, MonoTime::from_us(77'123'456)));
}

TEST(FigureHands, FingersAreAsDancedOrSlightlyCurled) {
  const auto avatar = shared(mannequin_of(average_skeleton()));
  FigurePoser poser;
  SceneGuest guest = guest_in(avatar);
  SceneState scene;
  scene.time = MonoTime::from_us(1'000'000);
  const auto bend = [&](std::size_t finger) {
    scene.guests = {guest};
    const PosedFigure& figure = poser.pose(scene)[0];
    const Eigen::Quaternionf R(
        Eigen::Matrix3f(figure.W_from_joint[kBoneCount + finger].leftCols<3>()));
    return R.angularDistance(figure.frames.R_WB[index_of(Bone::kLeftHand)]);
  };
  EXPECT_NEAR(bend(8), 0.93f, 0.05f);  // the middle finger at rest
  guest.hands.emplace();
  guest.hands->presence = 1u << 6 | 1u << 7 | 1u << 8;
  EXPECT_NEAR(bend(8), 0.0f, 0.01f);  // stretched, as danced
  EXPECT_NEAR(bend(5), 0.93f, 0.05f);
}

}  // namespace
}  // namespace dance
