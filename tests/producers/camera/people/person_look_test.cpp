#include "producers/camera/people/person_look.h"

#include <gtest/gtest.h>

#include "tests/producers/camera/people/crossing_couple.h"

namespace dance {
namespace {

class PersonLookTest : public testing::Test {
 protected:
  PersonLook look(std::size_t dancer, std::size_t frame) {
    scene_.show(frame);
    const BodyLandmarks& seen = scene_.scene(dancer).frames[frame].landmarks;
    SeenBody body;
    body.image_px = seen.image_px;
    body.visibility = seen.visibility;
    return look_of(body, scene_);
  }
  CoupleScene scene_{crossing_couple(12.0), kCoupleHz, {}, {}, 1};
};

TEST_F(PersonLookTest, SeesTheClothes) {
  const PersonLook first = look(0, 0), second = look(1, 0);
  ASSERT_TRUE(first.is_seen[0] && second.is_seen[0]);
  EXPECT_LT((first.colour[0] - kWhite).norm(), 0.1f);
  EXPECT_LT((second.colour[0] - kRed).norm(), 0.1f);
}

TEST_F(PersonLookTest, TellsTheDancersApart) {
  std::array<LookModel, 2> models;
  EXPECT_FALSE(models[0].is_known());
  EXPECT_FALSE(models[0].distance(look(0, 0)).has_value());
  for (std::size_t f = 0; f < 20; ++f)
    for (std::size_t i = 0; i < 2; ++i) models[i].learn(look(i, f));
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(models[i].is_known());
    const auto own = models[i].distance(look(i, 25)), other = models[1 - i].distance(look(i, 25));
    ASSERT_TRUE(own && other);
    EXPECT_LT(*own, 3.0f);
    EXPECT_GT(*other, 5.0f);
  }
  EXPECT_LT(models[0].distance(kWhite), 1.0f);
  EXPECT_GT(models[0].distance(kRed), 5.0f);
}

TEST_F(PersonLookTest, WhatIsNotVisibleIsNotJudged) {
  scene_.show(0);
  SeenBody body;
  body.image_px = scene_.scene(0).frames[0].landmarks.image_px;
  body.visibility.fill(0.1f);
  const PersonLook nothing = look_of(body, scene_);
  for (const bool is_seen : nothing.is_seen) EXPECT_FALSE(is_seen);
  LookModel model;
  for (std::size_t f = 0; f < 20; ++f) model.learn(look(0, f));
  EXPECT_FALSE(model.distance(nothing).has_value());
}

}  // namespace
}  // namespace dance
