#include "formats/rokoko/rokoko_actor.h"

#include "core/pose/kinematics.h"
#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

constexpr std::size_t kFingersOfAHand = 5;
// Of a left hand in T-pose, from the wrist, for a hand that is 185 mm long: where each finger's
// first joint is, and the lengths of its three bones; millimetres, axes of W. After the proportions
// of an average adult's hand.
struct Finger {
  float x_mm, y_mm, z_mm;
  float lengths_mm[3];
};
constexpr Finger kFingers[kFingersOfAHand] = {{20.0f, -8.0f, 24.0f, {46.0f, 34.0f, 28.0f}},
                                              {93.0f, 0.0f, 24.0f, {42.0f, 25.0f, 22.0f}},
                                              {94.0f, 0.0f, 3.0f, {45.0f, 28.0f, 23.0f}},
                                              {88.0f, 0.0f, -17.0f, {41.0f, 27.0f, 23.0f}},
                                              {80.0f, 0.0f, -34.0f, {33.0f, 20.0f, 20.0f}}};
constexpr float kHandLength_m = 0.185f;
// A thumb's first bone points 30° forward.
const Eigen::Vector3f kThumb(0.8660254f, 0.0f, 0.5f);

void put(RokokoActor& actor, std::size_t joint, const Eigen::Vector3f& p_W_m,
         const Eigen::Quaternionf& R_W) {
  actor.joints[joint] = {mirrored(p_W_m), rokoko_from_W(joint, R_W).normalized()};
  actor.present[joint] = true;
}

// Begins at our spine and points at the upper chest; turned about its length half as far as the
// chest is against the spine.
Eigen::Quaternionf spine_rotation(const Skeleton& skeleton, const BodyFrames& frames) {
  const auto& R_spine = frames.R_WB[index_of(Bone::kSpine)];
  const auto& R_chest = frames.R_WB[index_of(Bone::kChest)];
  const Eigen::Quaternionf middle = R_spine.slerp(0.5f, R_chest);
  const Eigen::Vector3f rest =
      middle * (skeleton.offset(Bone::kChest) + skeleton.offset(Bone::kUpperChest));
  const Eigen::Vector3f chord = frames.position(Bone::kUpperChest) - frames.position(Bone::kSpine);
  return shortest_turn(rest.cast<double>(), chord.cast<double>()).cast<float>() * middle;
}

void put_fingers(const Skeleton& skeleton, const BodyFrames& frames, const Hands& hands,
                 RokokoActor& actor) {
  for (const bool is_left : {true, false}) {
    const Bone hand = is_left ? Bone::kLeftHand : Bone::kRightHand;
    const float side = is_left ? 1.0f : -1.0f;
    const float scale =
        skeleton.tip(is_left ? Tip::kLeftHand : Tip::kRightHand).norm() / kHandLength_m * 0.001f;
    for (std::size_t f = 0; f < kFingersOfAHand; ++f) {
      const Finger& finger = kFingers[f];
      const std::size_t which = is_left ? f : f + kFingersOfAHand;
      Eigen::Quaternionf R_W = frames.R_WB[index_of(hand)];
      Eigen::Vector3f p_W_m =
          frames.position(hand) +
          R_W * (scale * Eigen::Vector3f(side * finger.x_mm, finger.y_mm, finger.z_mm));
      for (std::size_t bone = 0; bone < 3; ++bone) {
        R_W = (R_W * hands.R_PB[3 * which + bone]).normalized();
        put(actor, rokoko_finger_joint(which, bone), p_W_m, R_W);
        Eigen::Vector3f along = f == 0 && bone == 0 ? kThumb : Eigen::Vector3f::UnitX();
        along.x() *= side;
        p_W_m += R_W * (scale * finger.lengths_mm[bone] * along);
      }
      put(actor, rokoko_finger_joint(which, 3), p_W_m, R_W);
    }
  }
}

}  // namespace

void make_rokoko_actor(const Skeleton& skeleton, const Pose& pose, const Hands* hands,
                       RokokoActor& actor) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  actor.present.reset();
  for (std::size_t j = 0; j < kRokokoBodyJointCount; ++j) {
    const auto bone = bone_of(static_cast<RokokoBody>(j));
    if (bone) put(actor, j, frames.position(*bone), frames.R_WB[index_of(*bone)]);
  }
  put(actor, index_of(RokokoBody::kSpine), frames.position(Bone::kSpine),
      spine_rotation(skeleton, frames));
  put(actor, index_of(RokokoBody::kLeftToeEnd), frames.tip(Tip::kLeftToes),
      frames.R_WB[index_of(Bone::kLeftToes)]);
  put(actor, index_of(RokokoBody::kRightToeEnd), frames.tip(Tip::kRightToes),
      frames.R_WB[index_of(Bone::kRightToes)]);
  actor.has_body = true;
  actor.has_face = false;
  actor.has_left_glove = actor.has_right_glove = hands != nullptr;
  if (hands) put_fingers(skeleton, frames, *hands, actor);
  actor.total_height_m = standing_height_m(skeleton);
  actor.hip_height_m = skeleton.hips_height_m();
}

}  // namespace dance
