#include "producers/camera/people/limb_owner.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr double kHz = 30.0;
MonoTime at(int frame) { return MonoTime() + Duration::seconds(1.0 + frame / kHz); }

// Stands at x, 400 pixels high; arms bent before the body.
SeenBody body_at(float x) {
  SeenBody body;
  for (auto& p : body.image_px) p = {x, 300.0f, 0.0f};
  const auto put = [&](Landmark left, float aside, float y) {
    body.image_px[index_of(left)] = {x + aside, y, 0.0f};
    body.image_px[index_of(left) + 1] = {x - aside, y, 0.0f};
  };
  put(Landmark::kLeftShoulder, 40.0f, 180.0f);
  put(Landmark::kLeftElbow, 60.0f, 250.0f);
  put(Landmark::kLeftWrist, 90.0f, 200.0f);
  put(Landmark::kLeftPinky, 95.0f, 195.0f);
  put(Landmark::kLeftIndex, 97.0f, 193.0f);
  put(Landmark::kLeftThumb, 95.0f, 190.0f);
  put(Landmark::kLeftHip, 25.0f, 300.0f);
  put(Landmark::kLeftKnee, 25.0f, 400.0f);
  put(Landmark::kLeftAnkle, 25.0f, 490.0f);
  put(Landmark::kLeftHeel, 25.0f, 495.0f);
  put(Landmark::kLeftFootIndex, 30.0f, 500.0f);
  body.visibility.fill(0.9f);
  body.next_px = {Eigen::Vector2f(x, 300.0f), Eigen::Vector2f(x, 80.0f)};
  return body;
}

bool is_hidden(const SeenBody& body, Landmark l) { return body.visibility[index_of(l)] < 0.2f; }

class LimbOwner : public testing::Test {
 protected:
  void SetUp() override {
    for (int f = 0; f < 10; ++f) {
      motions_[0].update(body_at(200.0f), at(f));
      motions_[1].update(body_at(400.0f), at(f));
    }
  }
  int resolve() {
    const LimbClaimant people[] = {{&bodies_[0], &motions_[0], true}, {&bodies_[1], &motions_[1]}};
    return resolve_limbs(people, at(10));
  }
  // The arm of the second is given to the first as well.
  void take_arm() {
    for (const Landmark l : {Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky,
                             Landmark::kLeftIndex, Landmark::kLeftThumb})
      bodies_[0].image_px[index_of(l)] = bodies_[1].image_px[index_of(l) + 1];
  }
  std::array<SeenBody, 2> bodies_{body_at(200.0f), body_at(400.0f)};
  std::array<LimbMotion, 2> motions_;
};

TEST_F(LimbOwner, LimbsThatAreApartAreLeft) {
  EXPECT_EQ(resolve(), 0);
  for (const SeenBody& body : bodies_)
    for (const float v : body.visibility) EXPECT_EQ(v, 0.9f);
}

TEST_F(LimbOwner, AnArmThatIsGivenToBothIsWhoseItWasExpectedToBe) {
  take_arm();
  EXPECT_EQ(resolve(), 1);
  EXPECT_TRUE(is_hidden(bodies_[0], Landmark::kLeftElbow));
  EXPECT_TRUE(is_hidden(bodies_[0], Landmark::kLeftWrist));
  EXPECT_TRUE(is_hidden(bodies_[0], Landmark::kLeftThumb));
  EXPECT_FALSE(is_hidden(bodies_[0], Landmark::kRightWrist));
  EXPECT_FALSE(is_hidden(bodies_[1], Landmark::kRightWrist));
}

TEST_F(LimbOwner, HandsInHoldStayBothTheirOwners) {
  // Both reach for the middle: wrists in one place, elbows apart.
  for (int f = 0; f < 10; ++f)
    for (std::size_t i = 0; i < 2; ++i) {
      SeenBody& body = bodies_[i];
      body = body_at(i == 0 ? 200.0f : 330.0f);
      const Landmark wrist = i == 0 ? Landmark::kLeftWrist : Landmark::kRightWrist;
      for (const std::size_t l : {0u, 2u, 4u, 6u})
        body.image_px[index_of(wrist) + l] = {265.0f, 230.0f, 0.0f};
      motions_[i].update(body, at(f));
    }
  EXPECT_EQ(resolve(), 0);
}

TEST_F(LimbOwner, AHandThatIsTooFarAwayIsTheOthers) {
  // The elbow is right, the hand is the partner's.
  for (const std::size_t l : {0u, 2u, 4u, 6u})
    bodies_[0].image_px[index_of(Landmark::kLeftWrist) + l] =
        bodies_[1].image_px[index_of(Landmark::kRightWrist)];
  EXPECT_EQ(resolve(), 1);
  EXPECT_TRUE(is_hidden(bodies_[0], Landmark::kLeftWrist));
  EXPECT_FALSE(is_hidden(bodies_[0], Landmark::kLeftElbow));
  EXPECT_FALSE(is_hidden(bodies_[1], Landmark::kRightWrist));
}

TEST_F(LimbOwner, WhatIsNotKnownYetIsDoubtful) {
  take_arm();
  motions_[0].reset();
  motions_[1].reset();
  EXPECT_EQ(resolve(), 0);
}

TEST_F(LimbOwner, PeopleWhoAreNotSeenClaimNothing) {
  const LimbClaimant people[] = {{&bodies_[0], &motions_[0], true}, {}, {}};
  EXPECT_EQ(resolve_limbs(people, at(10)), 0);
}

}  // namespace
}  // namespace dance
