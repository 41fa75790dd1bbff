// Bare hands: where a controller would be held, and how their fingers bend.
#include "producers/xr/xr_hands.h"

#include <gtest/gtest.h>

#include "core/pose/mirror.h"
#include "testing/xr/script/hand_skeleton.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::array<XrHand, 2> kBothHands{XrHand::kLeft, XrHand::kRight};

// As OpenXR has joints: -Z to the tip, +Y out of the back.
Quaternionf joint_that_points(const Vector3f& tip, const Vector3f& back) {
  Eigen::Matrix3f R;
  R.col(2) = -tip;
  R.col(1) = back;
  R.col(0) = back.cross(-tip);
  return Quaternionf(R);
}

// A flat hand in T-pose facing +Z, back up: a left one along +X. The thumb lies 45 degrees forward.
XrHandJoints flat_hand(XrHand hand) {
  const auto of_hand = [&](const Vector3f& left) {
    return hand == XrHand::kLeft ? left : mirrored(left);
  };
  XrHandJoints joints;
  for (std::size_t i = 0; i < joints.joints.size(); ++i) {
    const bool is_thumb =
        i >= XR_HAND_JOINT_THUMB_METACARPAL_EXT && i <= XR_HAND_JOINT_THUMB_TIP_EXT;
    joints.joints[i].R = is_thumb
                             ? joint_that_points(of_hand({0.70710678f, 0.0f, 0.70710678f}),
                                                 of_hand({-0.56568542f, 0.6f, 0.56568542f}))
                             : joint_that_points(of_hand(Vector3f::UnitX()), Vector3f::UnitY());
  }
  return joints;
}

XrHandJoints scripted_hand(XrHand hand, bool is_fist) {
  const auto skeleton = test_xr::hand_skeleton(
      hand == XrHand::kLeft ? test_xr::Hand::kLeft : test_xr::Hand::kRight, is_fist);
  XrHandJoints joints;
  for (std::size_t i = 0; i < joints.joints.size(); ++i)
    joints.joints[i] = {skeleton.T_GJ[i].translation().cast<float>(),
                        Quaternionf(Eigen::Quaterniond(skeleton.T_GJ[i].linear()).cast<float>())};
  return joints;
}

// 15 bones of a side, thumb to little finger, three of each.
std::size_t finger_bone(XrHand hand, std::size_t finger, std::size_t bone) {
  return (hand == XrHand::kLeft ? 0 : kFingerBoneCount / 2) + 3 * finger + bone;
}

TEST(XrGripOf, PointsToTheThumbAndOutOfALeftPalmAndARightBack) {
  for (const XrHand hand : kBothHands) {
    const bool is_left = hand == XrHand::kLeft;
    XrHandJoints joints;  // fingers along -Z, back up
    joints.joints[XR_HAND_JOINT_PALM_EXT].p_m = {1.0f, 2.0f, 3.0f};
    const XrPlace grip = grip_of(joints, hand);
    const Vector3f thumb = is_left ? Vector3f::UnitX() : Vector3f(-Vector3f::UnitX());
    EXPECT_LT((grip.R * -Vector3f::UnitZ() - thumb).norm(), 1e-6f);
    const float palm = is_left ? 1.0f : -1.0f;
    EXPECT_LT((grip.R * Vector3f::UnitX() - palm * -Vector3f::UnitY()).norm(), 1e-6f);
    EXPECT_LT((grip.R * -Vector3f::UnitY() - -Vector3f::UnitZ()).norm(), 1e-6f) << "fingers";
    EXPECT_NEAR(grip.p_m.y(), 1.98f, 1e-6f) << "before the palm, where a handle would be";
  }
}

TEST(XrGripOf, IsWhereTheRuntimeSaysThatAControllerIs) {
  for (const XrHand hand : kBothHands) {
    const XrPlace grip = grip_of(scripted_hand(hand, false), hand);
    EXPECT_LT(grip.p_m.norm(), 1e-5f);
    EXPECT_LT(grip.R.angularDistance(Quaternionf::Identity()), 1e-3f);
  }
}

TEST(XrFingers, OfAFlatHandInTPoseAreNotTurnedHoweverTheHandIsHeld) {
  for (const XrHand hand : kBothHands)
    for (const float turn : {0.0f, 1.0f, -2.0f}) {
      XrHandJoints joints = flat_hand(hand);
      const Quaternionf R(Eigen::AngleAxisf(turn, Vector3f(1.0f, 2.0f, -1.0f).normalized()));
      for (XrPlace& joint : joints.joints) joint.R = R * joint.R;
      Hands hands;
      write_fingers(joints, hand, hands);
      const std::uint32_t side = (1u << (kFingerBoneCount / 2)) - 1;
      EXPECT_EQ(hands.presence, hand == XrHand::kLeft ? side : side << (kFingerBoneCount / 2));
      for (std::size_t i = 0; i < kFingerBoneCount; ++i)
        EXPECT_LT(hands.R_PB[i].angularDistance(Quaternionf::Identity()), 2e-3f)
            << kFingerBones[i].name;
    }
}

TEST(XrFingers, ABentJointIsItsOwnBonesTurnAndNobodyElses) {
  constexpr float kBend_rad = 0.9f;
  for (const XrHand hand : kBothHands) {
    const float towards_palm = hand == XrHand::kLeft ? -kBend_rad : kBend_rad;
    const Quaternionf bend(Eigen::AngleAxisf(towards_palm, Vector3f::UnitZ()));
    XrHandJoints joints = flat_hand(hand);
    for (const int joint : {XR_HAND_JOINT_MIDDLE_INTERMEDIATE_EXT, XR_HAND_JOINT_MIDDLE_DISTAL_EXT,
                            XR_HAND_JOINT_MIDDLE_TIP_EXT}) {
      XrPlace& place = joints.joints[static_cast<std::size_t>(joint)];
      place.R = bend * place.R;
    }
    Hands hands;
    write_fingers(joints, hand, hands);
    for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
      const bool is_bent = i == finger_bone(hand, 2, 1);
      EXPECT_LT(hands.R_PB[i].angularDistance(is_bent ? bend : Quaternionf::Identity()), 2e-3f)
          << kFingerBones[i].name;
    }
  }
}

TEST(XrFingers, OfAFistBendTowardsThePalmAtEachJoint) {
  for (const XrHand hand : kBothHands) {
    Hands flat, fist;
    write_fingers(scripted_hand(hand, false), hand, flat);
    write_fingers(scripted_hand(hand, true), hand, fist);
    const Vector3f along = hand == XrHand::kLeft ? Vector3f::UnitX() : Vector3f(-1.0f, 0.0f, 0.0f);
    for (std::size_t finger = 1; finger < 5; ++finger)
      for (std::size_t bone = 0; bone < 3; ++bone) {
        const std::size_t i = finger_bone(hand, finger, bone);
        EXPECT_NEAR((flat.R_PB[i] * along).y(), 0.0f, 1e-3f) << kFingerBones[i].name;
        EXPECT_NEAR((fist.R_PB[i] * along).y(), -std::sin(1.4f), 1e-2f) << kFingerBones[i].name;
      }
    const std::size_t thumb = finger_bone(hand, 0, 1);
    EXPECT_NEAR(fist.R_PB[thumb].angularDistance(Quaternionf::Identity()), 0.5f, 1e-2f);
  }
}

TEST(XrFingers, ThumbAndForefingerThatTouchAreAPinch) {
  XrHandJoints joints = scripted_hand(XrHand::kRight, false);
  EXPECT_FALSE(is_pinching(joints));
  joints.joints[XR_HAND_JOINT_THUMB_TIP_EXT].p_m =
      joints.joints[XR_HAND_JOINT_INDEX_TIP_EXT].p_m + Vector3f(0.0f, 0.01f, 0.0f);
  EXPECT_TRUE(is_pinching(joints));
}

}  // namespace
}  // namespace dance
