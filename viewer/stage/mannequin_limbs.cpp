#include "viewer/stage/mannequin_builder.h"

namespace dance {

using Eigen::Vector3f;

void MannequinBuilder::add_arm(Side side) {
  const bool left = side == Side::kLeft;
  const Bone upper = left ? Bone::kLeftUpperArm : Bone::kRightUpperArm;
  const Bone lower = left ? Bone::kLeftLowerArm : Bone::kRightLowerArm;
  const Bone hand = left ? Bone::kLeftHand : Bone::kRightHand;
  const Vector3f shoulder = frames_.position(upper);
  const Vector3f elbow = frames_.position(lower);
  const Vector3f wrist = frames_.position(hand);
  const Vector3f up = axis(upper, Vector3f::UnitY());
  const Colour& sleeve_upper = look_.sleeves == Sleeves::kLong ? top_ : skin_;
  const Colour& sleeve_lower = look_.sleeves == Sleeves::kLong ? top_ : skin_;

  const auto between = [](const Vector3f& a, const Vector3f& b, float t) -> Vector3f {
    return a + t * (b - a);
  };
  large(cone(shoulder, 0.055f, elbow, 0.038f, up, sleeve_upper));
  if (look_.sleeves == Sleeves::kShort) {
    // The sleeve ends half way, a little wider than the arm.
    BodyPart sleeve = cone(shoulder, 0.058f, between(shoulder, elbow, 0.5f), 0.054f, up, top_);
    sleeve.flat_b = 0.12f;
    large(sleeve);
  }
  const Vector3f belly = between(elbow, wrist, 0.28f);
  large(cone(elbow, 0.038f, belly, 0.041f, up, sleeve_lower));
  large(cone(belly, 0.041f, wrist, look_.sleeves == Sleeves::kLong ? 0.031f : 0.026f, up,
             sleeve_lower));
}

void MannequinBuilder::add_leg(Side side) {
  const bool left = side == Side::kLeft;
  const Bone upper = left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
  const Bone lower = left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg;
  const Vector3f x = axis(upper, Vector3f::UnitX());
  const bool bare = look_.legwear == Legwear::kSkirt;
  // Under a skirt the thigh begins lower and thinner, so that it stays under the cloth.
  const Vector3f knee = frames_.position(lower);
  if (bare) {
    const Vector3f hip = frames_.position(upper);
    large(cone(hip + 0.3f * (knee - hip), 0.068f, knee, 0.055f, x, skin_));
  } else {
    large(cone(at(upper, {0, -0.02f, 0}), 0.09f, knee, 0.061f, x, legs_));
  }
  add_lower_leg(side);
  add_shoe(side);
}

void MannequinBuilder::add_lower_leg(Side side) {
  const bool left = side == Side::kLeft;
  const Bone lower = left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg;
  const Bone foot = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const Vector3f x = axis(lower, Vector3f::UnitX());
  const Vector3f knee = frames_.position(lower);
  const Vector3f ankle = frames_.position(foot);
  const Vector3f backward = axis(lower, -Vector3f::UnitZ());

  if (look_.legwear == Legwear::kSkirt) {
    const Vector3f calf = knee + 0.33f * (ankle - knee) + 0.016f * scale_ * backward;
    large(cone(knee, 0.053f, calf, 0.055f, x, skin_));
    large(cone(calf, 0.055f, ankle, 0.034f, x, skin_));
    return;
  }
  const Vector3f hem = ankle + 0.03f * (knee - ankle);
  const bool flared = look_.legwear == Legwear::kFlared;
  BodyPart shin = cone(knee, 0.06f, hem, flared ? 0.088f : 0.058f, x, legs_);
  shin.flat_b = 0.12f;
  large(shin);
  if (!flared) {
    const Vector3f calf = knee + 0.3f * (ankle - knee) + 0.008f * scale_ * backward;
    large(cone(knee, 0.056f, calf, 0.058f, x, legs_));
  }
  large(cone(knee + 0.7f * (ankle - knee), 0.04f, ankle, 0.036f, x, skin_));
}

void MannequinBuilder::add_shoe(Side side) {
  const bool left = side == Side::kLeft;
  const Bone foot = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const Bone toes = left ? Bone::kLeftToes : Bone::kRightToes;
  const Tip tip = left ? Tip::kLeftToes : Tip::kRightToes;
  const Vector3f foot_x = axis(foot, Vector3f::UnitX());
  const Vector3f toes_x = axis(toes, Vector3f::UnitX());
  // How far the sole lies below ankle and ball when the foot stands flat: from the guest's own
  // skeleton, so that soles meet the floor.
  const float under_ball_m = guest_.skeleton.tip(tip).y() / scale_;
  const float under_ankle_m = guest_.skeleton.offset(toes).y() / scale_ + under_ball_m;
  constexpr float kSole_m = 0.011f;
  constexpr float kThin = 0.32f;

  const Vector3f toe_end = frames_.tip(tip);
  large(cone(at(foot, {0, under_ankle_m + 0.044f, -0.03f}), 0.037f, at(foot, {0, -0.006f, -0.004f}),
             0.041f, foot_x, shoes_));
  BodyPart instep = cone(at(foot, {0, -0.016f, 0.006f}), 0.04f,
                         at(toes, {0, under_ball_m + 0.034f, 0}), 0.031f, foot_x, shoes_);
  instep.width = 1.12f;
  large(instep);
  BodyPart toe_box =
      cone(at(toes, {0, under_ball_m + 0.033f, 0}), 0.031f,
           toe_end + scale_ * 0.024f * axis(toes, Vector3f::UnitY()), 0.021f, toes_x, shoes_);
  toe_box.width = 1.25f;
  large(toe_box);

  const Colour sole{0.25f * look_.shoes + Vector3f::Constant(0.01f), 0.1f};
  BodyPart heel_sole = cone(at(foot, {0, under_ankle_m + kSole_m, -0.038f}), 0.034f,
                            at(toes, {0, under_ball_m + kSole_m, 0}), 0.037f, foot_x, sole);
  heel_sole.width = 1.08f;
  heel_sole.depth = kThin;
  large(heel_sole);
  BodyPart toe_sole =
      cone(at(toes, {0, under_ball_m + kSole_m, 0}), 0.037f,
           toe_end + scale_ * kSole_m * axis(toes, Vector3f::UnitY()), 0.026f, toes_x, sole);
  toe_sole.width = 1.08f;
  toe_sole.depth = kThin;
  large(toe_sole);
}

}  // namespace dance
