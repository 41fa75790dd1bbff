#include "producers/camera/hands/palm_wrist.h"

#include <gtest/gtest.h>

#include "producers/camera/region/half_turn.h"
#include "tests/producers/camera/hands/built_hand.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

Quaternionf about(const Vector3f& axis, float degrees) {
  return Quaternionf(AngleAxisf(radians(degrees), axis));
}

// Palms that are turned by this in the hand, seen for as many pictures.
PalmWrist seen(const Quaternionf& turn, int pictures) {
  PalmWrist wrist;
  const Pose pose;
  const Quaternionf R_WHand = rotation_in_W(pose, Bone::kLeftHand);
  for (int i = 0; i < pictures; ++i)
    wrist.see(HandSide::kLeft, R_WHand * turn, R_WHand, 1.0f, picture_time(i));
  return wrist;
}

TEST(PalmWrist, AHandComesToFaceAsItsPalmIsSeen) {
  const Quaternionf turn = about(Vector3f::UnitX(), 40.0f) * about(Vector3f::UnitZ(), 20.0f);
  const PalmWrist wrist = seen(turn, 120);
  Pose pose;
  wrist.apply(picture_time(120), pose);
  EXPECT_LT(rotation_in_W(pose, Bone::kLeftHand).angularDistance(turn), radians(1.0f));
  // Half of the twist is the forearm's, whose place does not move by it.
  EXPECT_NEAR(pose.R_PB[index_of(Bone::kLeftLowerArm)].angularDistance(Quaternionf::Identity()),
              radians(20.0f), radians(2.0f));
  EXPECT_EQ(pose.R_PB[index_of(Bone::kRightHand)].angularDistance(Quaternionf::Identity()), 0.0f);
}

TEST(PalmWrist, ComesInByAndByAndFades) {
  const Quaternionf turn = about(Vector3f::UnitZ(), 40.0f);
  float last = 0.0f;
  for (int pictures = 1; pictures < 12; ++pictures) {
    Pose pose;
    seen(turn, pictures).apply(picture_time(pictures), pose);
    const float angle =
        rotation_in_W(pose, Bone::kLeftHand).angularDistance(Quaternionf::Identity());
    EXPECT_GT(angle, last);
    EXPECT_LT(angle, last + radians(12.0f));
    last = angle;
  }
  const PalmWrist wrist = seen(turn, 40);
  Pose later;
  wrist.apply(picture_time(40 + 30), later);
  EXPECT_EQ(rotation_in_W(later, Bone::kLeftHand).angularDistance(Quaternionf::Identity()), 0.0f);
}

TEST(PalmWrist, DoesNotFollowAHandThatIsHalfHidden) {
  PalmWrist wrist;
  Pose pose;
  const Quaternionf R_WHand = rotation_in_W(pose, Bone::kLeftHand);
  for (int i = 0; i < 40; ++i)
    wrist.see(HandSide::kLeft, R_WHand * about(Vector3f::UnitX(), 40.0f), R_WHand, 0.5f,
              picture_time(i));
  wrist.apply(picture_time(40), pose);
  EXPECT_EQ(rotation_in_W(pose, Bone::kLeftHand).angularDistance(Quaternionf::Identity()), 0.0f);
}

TEST(PalmWrist, RefusesAPalmThatLooksTheOtherWay) {
  Pose pose;
  seen(about(Vector3f::UnitX(), 150.0f), 40).apply(picture_time(40), pose);
  EXPECT_EQ(rotation_in_W(pose, Bone::kLeftHand).angularDistance(Quaternionf::Identity()), 0.0f);
}

TEST(PalmWrist, AForearmTurnsNoFurtherThanForearmsDo) {
  Pose pose;
  pose.R_PB[index_of(Bone::kLeftLowerArm)] = about(Vector3f::UnitX(), 60.0f);
  const Quaternionf R_WHand = rotation_in_W(pose, Bone::kLeftHand);
  PalmWrist wrist;
  for (int i = 0; i < 40; ++i)
    wrist.see(HandSide::kLeft, R_WHand * about(Vector3f::UnitX(), 90.0f), R_WHand, 1.0f,
              picture_time(i));
  wrist.apply(picture_time(40), pose);
  EXPECT_LT(rotation_in_W(pose, Bone::kLeftHand).angularDistance(Quaternionf::Identity()),
            radians(81.0f));
  EXPECT_TRUE(is_valid(pose));
}

}  // namespace
}  // namespace dance
