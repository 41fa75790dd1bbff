#include <cmath>

#include "viewer/stage/mannequin_builder.h"

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

// A hand in T-pose points along ±X with the palm down and the thumb towards +Z. Lengths are shares
// of the hand, wrist to finger tips; finger order as in kFingerBones.
constexpr float kPalmShare = 0.5f;
constexpr std::size_t kFingersOfAHand = 5;
constexpr std::size_t kBonesOfAFinger = 3;
struct FingerShape {
  float across_m;  // of the knuckle, towards the thumb
  float length_share;
  float radius_m;
};
constexpr FingerShape kFingerShapes[kFingersOfAHand] = {{0.027f, 0.5f, 0.0125f},
                                                        {0.027f, 0.46f, 0.0102f},
                                                        {0.009f, 0.5f, 0.0104f},
                                                        {-0.009f, 0.47f, 0.01f},
                                                        {-0.026f, 0.38f, 0.0088f}};
constexpr float kBoneShares[kBonesOfAFinger] = {0.44f, 0.31f, 0.25f};
// Of a hand that rests: where a guest sends no fingers.
constexpr float kRestingCurl_rad[kBonesOfAFinger] = {0.3f, 0.38f, 0.25f};

Bone hand_of(Side side) { return side == Side::kLeft ? Bone::kLeftHand : Bone::kRightHand; }
Vector3f along_hand(Side side) { return Vector3f(sign_of(side), 0.0f, 0.0f); }

Quaternionf resting(Side side, float curl_rad) {
  const Vector3f curl_axis = along_hand(side).cross(Vector3f(0.0f, -1.0f, 0.0f));
  return Quaternionf(Eigen::AngleAxisf(curl_rad, curl_axis));
}

float hand_length_m(const Skeleton& skeleton, Side side) {
  return skeleton.tip(side == Side::kLeft ? Tip::kLeftHand : Tip::kRightHand).norm();
}

}  // namespace

void MannequinBuilder::add_hand(Side side) {
  add_palm(side);
  if (guest_.hands || detail_ == BodyDetail::kFine)
    add_fingers(side);
  else
    add_mitten(side);
}

void MannequinBuilder::add_palm(Side side) {
  const Bone hand = hand_of(side);
  const float length = hand_length_m(guest_.skeleton, side) / scale_;
  const Vector3f t = along_hand(side);
  BodyPart palm = cone(at(hand, 0.02f * t), 0.026f, at(hand, (kPalmShare - 0.1f) * length * t),
                       0.032f, axis(hand, Vector3f::UnitZ()), skin_);
  palm.width = 1.2f;
  palm.depth = 0.5f;
  large(palm);
}

void MannequinBuilder::add_mitten(Side side) {
  const Bone hand = hand_of(side);
  const float length = hand_length_m(guest_.skeleton, side) / scale_;
  const Vector3f t = along_hand(side);
  BodyPart mitten = cone(at(hand, (kPalmShare - 0.08f) * length * t), 0.031f,
                         at(hand, 0.85f * length * t + Vector3f(0, -0.022f, 0)), 0.022f,
                         axis(hand, Vector3f::UnitZ()), skin_);
  mitten.width = 1.2f;
  mitten.depth = 0.5f;
  small(mitten);
  small(cone(at(hand, 0.03f * t + Vector3f(0, 0, 0.02f)), 0.014f,
             at(hand, 0.42f * length * t + Vector3f(0, -0.01f, 0.055f)), 0.01f,
             axis(hand, Vector3f::UnitY()), skin_));
}

void MannequinBuilder::add_fingers(Side side) {
  const float length = hand_length_m(guest_.skeleton, side) / scale_;
  const Vector3f t = along_hand(side);
  for (std::size_t finger = 0; finger < kFingersOfAHand; ++finger) {
    const FingerShape& shape = kFingerShapes[finger];
    const bool thumb = finger == 0;
    const float out = thumb ? 0.12f : kPalmShare;
    const Vector3f direction =
        thumb ? Vector3f((0.84f * t + Vector3f(0, -0.16f, 0.52f)).normalized()) : Vector3f(t);
    add_finger(side, finger * kBonesOfAFinger,
               Vector3f(out * length * t + Vector3f(0, 0, shape.across_m)), direction,
               shape.length_share * length, shape.radius_m);
  }
}

void MannequinBuilder::add_finger(Side side, std::size_t first_bone, const Vector3f& root_local_m,
                                  const Vector3f& direction_local, float length_m, float radius_m) {
  const bool thumb = first_bone == 0;
  const std::size_t side_offset = side == Side::kLeft ? 0 : kFingerBoneCount / 2;
  const Bone hand = hand_of(side);
  Vector3f place = at(hand, root_local_m);
  Quaternionf R_WF = frames_.R_WB[index_of(hand)];
  for (std::size_t i = 0; i < kBonesOfAFinger; ++i) {
    if (guest_.hands)
      R_WF = R_WF * guest_.hands->R_PB[side_offset + first_bone + i];
    else
      R_WF = R_WF * resting(side, thumb ? 0.4f * kRestingCurl_rad[i] : kRestingCurl_rad[i]);
    const Vector3f end = place + scale_ * length_m * kBoneShares[i] * (R_WF * direction_local);
    const float thinner = 1.0f - 0.12f * static_cast<float>(i);
    small(cone(place, radius_m * thinner, end, radius_m * (thinner - 0.12f),
               R_WF * Vector3f::UnitY(), skin_));
    place = end;
  }
}

}  // namespace dance
