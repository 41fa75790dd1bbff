#include "producers/camera/hands/finger_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "producers/camera/region/half_turn.h"
#include "tests/producers/camera/hands/built_hand.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::array kSides{HandSide::kLeft, HandSide::kRight};

MonoTime picture_time(int picture) {
  return MonoTime{} + Duration::s(1) + Duration::ms(33 * picture);
}

Quaternionf random_rotation(Random& random) {
  const auto number = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
  return Quaternionf(number(), number(), number(), number()).normalized();
}

FingerAngles random_angles(Random& random) {
  FingerAngles angles;
  const auto between = [&](float low, float high) {
    return static_cast<float>(random.uniform(low, high));
  };
  for (std::size_t finger = 1; finger < 5; ++finger) {
    angles.bend[finger] = {between(0.0f, 1.2f), between(0.0f, 1.8f), between(0.0f, 1.2f)};
    angles.spread[finger] = between(-0.08f, 0.08f);
  }
  angles.bend[0] = {between(-0.3f, 0.6f), between(0.0f, 0.9f), between(0.0f, 1.2f)};
  angles.spread[0] = between(-0.2f, 0.7f);
  return angles;
}

TEST(FingerSolver, FindsTheAnglesThatAHandHasHoweverItIsTurned) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const HandSide side = kSides[static_cast<std::size_t>(i) % 2];
    const FingerAngles due = random_angles(random);
    Hands hands;
    write_fingers(due, side, hands);
    const HandLandmarks hand = hand_of(hands, random_rotation(random), side);
    const auto palm = palm_of(hand, side);
    ASSERT_TRUE(palm);
    const FingerAngles got = finger_angles(hand, *palm, side);
    for (std::size_t finger = 0; finger < 5; ++finger) {
      EXPECT_NEAR(got.spread[finger], due.spread[finger], 2e-3f) << i << " finger " << finger;
      for (std::size_t joint = 0; joint < 3; ++joint)
        EXPECT_NEAR(got.bend[finger][joint], due.bend[finger][joint], 4e-3f)
            << i << " finger " << finger << " joint " << joint;
    }
  }
}

TEST(FingerSolver, APalmIsTheHandBoneTurnedIntoTheCamera) {
  Random random(6);
  for (const HandSide side : kSides) {
    const Quaternionf R = random_rotation(random);
    const auto palm = palm_of(hand_of({}, R, side), side);
    ASSERT_TRUE(palm);
    EXPECT_LT(palm->angularDistance(R), 2e-3f);
  }
  HandLandmarks point;
  for (Vector3f& p : point.world_m) p.setZero();
  EXPECT_FALSE(palm_of(point, HandSide::kLeft));
  point.world_m[kHandMiddle].x() = std::nanf("");
  EXPECT_FALSE(palm_of(point, HandSide::kLeft));
}

TEST(FingerSolver, NoFingerBendsBackwardsOrFurtherThanFingersDo) {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    HandLandmarks hand;
    hand.found = true;
    for (Vector3f& p : hand.world_m)
      for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(random.uniform(-0.1, 0.1));
    const auto palm = palm_of(hand, HandSide::kLeft);
    if (!palm) continue;
    const FingerAngles angles = finger_angles(hand, *palm, HandSide::kLeft);
    for (std::size_t finger = 1; finger < 5; ++finger) {
      for (const float bend : angles.bend[finger]) {
        EXPECT_GE(bend, 0.0f);
        EXPECT_LE(bend, radians(110.0f));
      }
      EXPECT_LE(std::abs(angles.spread[finger]), radians(25.01f));
    }
    Hands out;
    write_fingers(angles, HandSide::kLeft, out);
    EXPECT_TRUE(is_valid(out));
    // Only a finger's first joint spreads: the others turn about one axis.
    for (std::size_t bone = 3; bone < 15; ++bone)
      if (bone % 3 != 0) {
        EXPECT_EQ(out.R_PB[bone].vec().head<2>().norm(), 0.0f);
      }
  }
}

TEST(FingerSolver, AFlatHandIsThatOfATPoseAndAFistTurnsTheTipsBack) {
  for (const HandSide side : kSides) {
    Hands flat;
    const HandLandmarks hand = hand_of(flat, Quaternionf::Identity(), side);
    Hands out;
    write_fingers(finger_angles(hand, *palm_of(hand, side), side), side, out);
    for (const Quaternionf& R : out.R_PB)
      EXPECT_LT(R.angularDistance(Quaternionf::Identity()), 0.01f);
    FingerAngles fist;
    for (std::size_t finger = 1; finger < 5; ++finger)
      fist.bend[finger] = {radians(90.0f), radians(100.0f), radians(60.0f)};
    write_fingers(fist, side, out);
    const HandLandmarks closed = hand_of(out, Quaternionf::Identity(), side);
    // Below the palm, and no further from the wrist than the knuckle.
    EXPECT_LT(closed.world_m[12].y(), -0.01f);
    EXPECT_LT(std::abs(closed.world_m[12].x()), std::abs(closed.world_m[kHandMiddle].x()));
  }
}

TEST(FingerSolver, AMirrorExchangesTheHands) {
  Random random(8);
  Hands hands;
  write_fingers(random_angles(random), HandSide::kLeft, hands);
  hands.presence = 0x7fff;
  const Hands before = hands;
  mirror(hands);
  EXPECT_EQ(hands.presence, 0x7fffu << 15);
  const HandLandmarks left = hand_of(before, Quaternionf::Identity(), HandSide::kLeft);
  const HandLandmarks right = hand_of(hands, Quaternionf::Identity(), HandSide::kRight);
  for (std::size_t i = 0; i < kHandPointCount; ++i) {
    const Vector3f seen(-right.world_m[i].x(), right.world_m[i].y(), right.world_m[i].z());
    EXPECT_LT((seen - left.world_m[i]).norm(), 1e-5f);
  }
  mirror(hands);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    EXPECT_LT(hands.R_PB[i].angularDistance(before.R_PB[i]), 1e-3f);
}

TEST(FingerSolver, AHiddenHandIsKeptAndThenRelaxes) {
  FingerSolver solver;
  FingerAngles bent;
  for (std::size_t finger = 1; finger < 5; ++finger) bent.bend[finger] = {1.0f, 1.0f, 0.5f};
  Hands built, out;
  EXPECT_FALSE(solver.write(picture_time(0), out));
  write_fingers(bent, HandSide::kLeft, built);
  const HandLandmarks hand = hand_of(built, Quaternionf::Identity(), HandSide::kLeft);
  HandLandmarks hidden;
  int picture = 0;
  for (; picture < 10; ++picture) solver.see(hand, HandSide::kLeft, picture_time(picture));
  ASSERT_TRUE(solver.write(picture_time(picture), out));
  EXPECT_EQ(out.presence, 0x7fffu);
  EXPECT_LT(out.R_PB[4].angularDistance(built.R_PB[4]), 0.02f);
  float last = 10.0f;
  for (; picture < 60; ++picture) {
    solver.see(hidden, HandSide::kLeft, picture_time(picture));
    const bool is_any = solver.write(picture_time(picture), out);
    EXPECT_EQ(out.presence, 0u);
    EXPECT_TRUE(is_valid(out));
    const float angle = out.R_PB[4].angularDistance(Quaternionf::Identity());
    EXPECT_LE(angle, last + 1e-4f);
    // No finger opens by more than a tenth of a radian from picture to picture.
    EXPECT_GT(angle, last - 0.1f - (last > 9.0f ? 10.0f : 0.0f));
    last = angle;
    EXPECT_EQ(is_any, picture < 55) << picture;
  }
  EXPECT_EQ(last, 0.0f);
}

}  // namespace
}  // namespace dance
