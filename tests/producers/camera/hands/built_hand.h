// Hands of known angles, and the points that a network would see of them.
//
// Units/frames: as producers/camera/hands/finger_solver.h says.
// Ownership:    values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "core/pose/pose.h"
#include "producers/camera/hands/finger_solver.h"

namespace dance {

// Of pictures at about 30 Hz.
inline MonoTime picture_time(int picture) {
  return MonoTime{} + Duration::s(1) + Duration::ms(33 * picture);
}

// The points of the side's fingers as `hands` bends them, with the hand turned by R_CHand.
inline HandLandmarks hand_of(const Hands& hands, const Eigen::Quaternionf& R_CHand, HandSide side) {
  HandLandmarks hand;
  hand.found = true;
  hand.presence = 1.0f;
  const float x = side == HandSide::kLeft ? 1.0f : -1.0f;
  const std::size_t first_bone = side == HandSide::kLeft ? 0 : kFingerBoneCount / 2;
  constexpr float kLengths_m[3] = {0.045f, 0.027f, 0.02f};
  hand.world_m[kHandWrist].setZero();
  for (std::size_t finger = 0; finger < 5; ++finger) {
    Eigen::Vector3f at(0.09f * x, 0.0f, 0.04f - 0.02f * static_cast<float>(finger));
    if (finger == 0) at = {0.02f * x, 0.0f, 0.02f};
    // Its knuckle lies straight before the wrist.
    if (finger == 2) at.z() = 0.0f;
    const Eigen::Vector3f rest =
        finger == 0 ? Eigen::Vector3f(x, 0.0f, 1.0f).normalized() : Eigen::Vector3f(x, 0.0f, 0.0f);
    Eigen::Quaternionf R = Eigen::Quaternionf::Identity();
    const std::size_t point = kHandThumb + 4 * finger;
    hand.world_m[point] = at;
    for (std::size_t joint = 0; joint < 3; ++joint) {
      R = R * hands.R_PB[first_bone + 3 * finger + joint];
      at += kLengths_m[joint] * (R * rest);
      hand.world_m[point + joint + 1] = at;
    }
  }
  for (Eigen::Vector3f& p : hand.world_m) p = R_CHand * p;
  return hand;
}

}  // namespace dance
