#include "formats/body/hand_layout.h"

#include <Eigen/Geometry>

namespace dance {
namespace {

using Eigen::Vector3f;

// Shares of the hand, wrist to finger tips, of an adult's average hand; thumb to little finger.
struct FingerShape {
  float along;   // of the first joint, from the wrist
  float across;  // towards the thumb
  float length;
  float radius;
};
constexpr FingerShape kShapes[kFingerCount / 2] = {{0.14f, 0.105f, 0.50f, 0.066f},
                                                   {0.50f, 0.098f, 0.46f, 0.054f},
                                                   {0.50f, 0.000f, 0.50f, 0.055f},
                                                   {0.49f, -0.096f, 0.46f, 0.053f},
                                                   {0.46f, -0.184f, 0.39f, 0.047f}};
constexpr float kBoneShares[kBonesOfAFinger] = {0.44f, 0.31f, 0.25f};
constexpr float kShortestHand_m = 0.02f;

Vector3f hand_vector(const Skeleton& skeleton, bool left) {
  const Tip tip = left ? Tip::kLeftHand : Tip::kRightHand;
  const Vector3f own = skeleton.tip(tip);
  return own.norm() >= kShortestHand_m ? own : average_skeleton().tip(tip);
}

}  // namespace

HandLayout hand_layout(const Skeleton& skeleton) {
  HandLayout layout;
  for (std::size_t finger = 0; finger < kFingerCount; ++finger) {
    const bool left = finger < kFingerCount / 2;
    const Vector3f hand = hand_vector(skeleton, left);
    const float length_m = hand.norm();
    const Vector3f along = hand / length_m;
    // The palm faces down, the thumb is in front: at rest it points half way there, as VRM has it.
    Vector3f front = Vector3f::UnitZ() - along.z() * along;
    front = front.norm() > 0.1f ? front.normalized() : Vector3f(along.unitOrthogonal());
    const FingerShape& shape = kShapes[finger % (kFingerCount / 2)];
    const bool thumb = finger % (kFingerCount / 2) == 0;
    const Vector3f direction = thumb ? Vector3f((along + front).normalized()) : along;
    const std::size_t first = finger * kBonesOfAFinger;
    layout.offset_m[first] = length_m * (shape.along * along + shape.across * front);
    for (std::size_t bone = 0; bone < kBonesOfAFinger; ++bone) {
      const Vector3f step = length_m * shape.length * kBoneShares[bone] * direction;
      if (bone + 1 < kBonesOfAFinger)
        layout.offset_m[first + bone + 1] = step;
      else
        layout.tip_m[finger] = step;
    }
  }
  return layout;
}

float finger_radius_m(std::size_t finger_bone, float hand_length_m) {
  constexpr float kThinner = 0.12f;  // from each bone to the next
  const std::size_t finger = finger_bone / kBonesOfAFinger % (kFingerCount / 2);
  const auto bone = static_cast<float>(finger_bone % kBonesOfAFinger);
  return hand_length_m * kShapes[finger].radius * (1.0f - kThinner * bone);
}

}  // namespace dance
