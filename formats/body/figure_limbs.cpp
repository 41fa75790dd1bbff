#include <algorithm>
#include <cmath>

#include "formats/body/figure_builder.h"
#include "formats/body/hand_layout.h"

namespace dance {

using Eigen::Vector3f;

namespace {
Vector3f between(const Vector3f& a, const Vector3f& b, float t) { return a + t * (b - a); }
}  // namespace

void FigureBuilder::add_sleeve(Side side, FigureLayer& top) const {
  if (look_.sleeves == Sleeves::kNone) return;
  const bool left = side == Side::kLeft;
  const Vector3f shoulder = places_.at(left ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
  const Vector3f elbow = places_.at(left ? Bone::kLeftLowerArm : Bone::kRightLowerArm);
  const Vector3f wrist = places_.at(left ? Bone::kLeftHand : Bone::kRightHand);
  const auto add = [&](const FigurePart& sleeve) {
    top.parts.push_back(sleeve);
    top.parts.back().limb = left ? FigureLimb::kLeftArm : FigureLimb::kRightArm;
  };
  if (look_.sleeves == Sleeves::kShort) {
    add(part(shoulder, 0.06f, between(shoulder, elbow, 0.45f), 0.056f));
    return;
  }
  add(part(shoulder, 0.059f, elbow, 0.044f));
  add(part(elbow, 0.044f, between(elbow, wrist, 0.28f), 0.046f));
  add(part(between(elbow, wrist, 0.28f), 0.046f, between(elbow, wrist, 0.93f), 0.036f));
}

void FigureBuilder::add_arm(Side side) {
  const bool left = side == Side::kLeft;
  const Vector3f shoulder = places_.at(left ? Bone::kLeftUpperArm : Bone::kRightUpperArm);
  const Vector3f elbow = places_.at(left ? Bone::kLeftLowerArm : Bone::kRightLowerArm);
  const Vector3f wrist = places_.at(left ? Bone::kLeftHand : Bone::kRightHand);
  const Vector3f belly = between(elbow, wrist, 0.28f);
  FigureLayer& skin = layer(Material::kSkin, 0.01f, 0.014f);
  // Below a sleeve there is no skin to be seen, nor any that could pierce the cloth.
  if (look_.sleeves != Sleeves::kLong) {
    const float start = look_.sleeves == Sleeves::kShort ? 0.3f : 0.0f;
    skin.parts.push_back(
        part(between(shoulder, elbow, start), 0.055f - 0.017f * start, elbow, 0.038f));
    skin.parts.push_back(part(elbow, 0.038f, belly, 0.041f));
    skin.parts.push_back(part(belly, 0.041f, wrist, 0.026f));
  } else {
    skin.parts.push_back(part(between(elbow, wrist, 0.85f), 0.028f, wrist, 0.026f));
  }
  for (FigurePart& each : skin.parts)
    each.limb = left ? FigureLimb::kLeftArm : FigureLimb::kRightArm;
  add_hand(side, skin);
}

void FigureBuilder::add_hand(Side side, FigureLayer& skin) const {
  const bool left = side == Side::kLeft;
  const Vector3f wrist = places_.at(left ? Bone::kLeftHand : Bone::kRightHand);
  const HandLayout layout = hand_layout(skeleton_);
  const std::size_t first_finger = left ? 0 : kFingerCount / 2;
  const auto knuckle = [&](std::size_t finger) -> Vector3f {
    return wrist + layout.offset_m[(first_finger + finger) * kBonesOfAFinger];
  };
  const Vector3f along = (knuckle(2) - wrist).normalized();
  const Vector3f front = (knuckle(1) - knuckle(4)).normalized();
  const float length_m = (knuckle(2) - wrist).norm() / 0.5f / places_.scale;
  FigurePart palm = part(between(wrist, knuckle(2), 0.15f), 0.025f,
                         between(wrist, knuckle(2), 0.82f), 0.031f, 1.22f, 0.5f);
  palm.side = front;
  skin.parts.push_back(palm);
  if (has_fingers_) return;
  const Vector3f up = left ? Vector3f(front.cross(along)) : Vector3f(along.cross(front));
  const float scale = places_.scale;
  FigurePart mitten =
      part(between(wrist, knuckle(2), 0.95f), 0.03f,
           wrist + scale * (0.84f * length_m * along - 0.02f * up), 0.021f, 1.25f, 0.5f);
  mitten.side = front;
  skin.parts.push_back(mitten);
  skin.parts.push_back(
      part(wrist + scale * (0.035f * along + 0.02f * front), 0.014f,
           wrist + scale * (0.42f * length_m * along - 0.01f * up + 0.055f * front), 0.0105f));
}

void FigureBuilder::add_finger(std::size_t finger) {
  const HandLayout layout = hand_layout(skeleton_);
  const std::size_t first = finger * kBonesOfAFinger;
  const Bone hand = hand_of_finger_bone(first);
  const float hand_m =
      skeleton_.tip(hand == Bone::kLeftHand ? Tip::kLeftHand : Tip::kRightHand).norm();
  FigureLayer& skin = layer(Material::kSkin, 0.0042f, 0.002f, FigureSkinning::kFinger);
  skin.finger = finger;
  Vector3f place = places_.at(hand);
  for (std::size_t bone = 0; bone < kBonesOfAFinger; ++bone) {
    place += layout.offset_m[first + bone];
    const bool last = bone + 1 == kBonesOfAFinger;
    const float radius_m = finger_radius_m(first + bone, hand_m);
    const float end_radius_m = last ? 0.85f * radius_m : finger_radius_m(first + bone + 1, hand_m);
    Vector3f end = place + (last ? layout.tip_m[finger] : layout.offset_m[first + bone + 1]);
    // The ball at the tip ends where the finger does.
    if (last) end -= end_radius_m * (end - place).normalized();
    FigurePart phalanx = part(place, 0.0f, end, 0.0f);
    phalanx.radius_a_m = radius_m;
    phalanx.radius_b_m = end_radius_m;
    phalanx.side = Vector3f::UnitY();
    skin.parts.push_back(phalanx);
  }
}

// Legs that touch would be one surface, and tear where they part.
float FigureBuilder::beside_other_leg(Bone bone, float radius_m) const {
  // More than half a cell of the surface; thighs meet at their upper end in any case.
  constexpr float kGap_m = 0.01f;
  constexpr float kThighGap_m = 0.004f;
  constexpr float kThinnest_m = 0.03f;
  const bool is_thigh = bone == Bone::kLeftUpperLeg || bone == Bone::kRightUpperLeg;
  const bool is_left = bone < Bone::kRightUpperLeg;
  const auto per_leg =
      static_cast<std::size_t>(Bone::kRightUpperLeg) - index_of(Bone::kLeftUpperLeg);
  const auto other =
      static_cast<Bone>(is_left ? index_of(bone) + per_leg : index_of(bone) - per_leg);
  const float half_m =
      0.5f * std::abs(places_.at(bone).x() - places_.at(other).x()) / places_.scale;
  return std::min(radius_m, std::max(kThinnest_m, half_m - (is_thigh ? kThighGap_m : kGap_m)));
}

void FigureBuilder::add_trouser_leg(Side side, FigureLayer& legs) const {
  const bool left = side == Side::kLeft;
  const Bone upper = left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
  const Vector3f knee = places_.at(left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg);
  const Vector3f ankle = places_.at(left ? Bone::kLeftFoot : Bone::kRightFoot);
  const auto add = [&](const FigurePart& leg) {
    legs.parts.push_back(leg);
    legs.parts.back().limb = left ? FigureLimb::kLeftLeg : FigureLimb::kRightLeg;
  };
  const Bone lower = left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg;
  const Bone foot = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const float knee_m = beside_other_leg(lower, 0.061f);
  const float calf_m = beside_other_leg(lower, 0.06f);
  add(part(at(upper, {0, -0.02f, 0}), beside_other_leg(upper, 0.09f), knee, knee_m));
  const Vector3f calf = between(knee, ankle, 0.3f) - places_.scale * 0.008f * Vector3f::UnitZ();
  add(part(knee, calf_m, calf, calf_m));
  const bool flared = look_.legwear == Legwear::kFlared;
  add(part(calf, calf_m, between(knee, ankle, 0.9f),
           beside_other_leg(foot, flared ? 0.084f : 0.056f)));
}

void FigureBuilder::add_bare_leg(Side side, float begin, FigureLayer& skin) const {
  const bool left = side == Side::kLeft;
  const Vector3f hip = places_.at(left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg);
  const Vector3f knee = places_.at(left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg);
  const Vector3f ankle = places_.at(left ? Bone::kLeftFoot : Bone::kRightFoot);
  const auto add = [&](const FigurePart& leg) {
    skin.parts.push_back(leg);
    skin.parts.back().limb = left ? FigureLimb::kLeftLeg : FigureLimb::kRightLeg;
  };
  const float top_m = 0.076f - 0.026f * begin;
  add(part(between(hip, knee, begin), top_m, between(hip, knee, 0.6f), 0.062f));
  add(part(between(hip, knee, 0.6f), 0.062f, knee, 0.05f));
  const Vector3f calf = between(knee, ankle, 0.33f) - places_.scale * 0.016f * Vector3f::UnitZ();
  add(part(knee, 0.05f, calf, 0.054f));
  add(part(calf, 0.054f, between(knee, ankle, 0.72f), 0.038f));
  add(part(between(knee, ankle, 0.72f), 0.038f, ankle, 0.034f));
}

void FigureBuilder::add_shorts() {
  FigureLayer& shorts = layer(Material::kLegs, 0.014f, 0.03f);
  add_hips(shorts);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool left = side == Side::kLeft;
    const Bone upper = left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
    const Vector3f knee = places_.at(left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg);
    const Vector3f hip = at(upper, {0, -0.02f, 0});
    shorts.parts.push_back(part(hip, beside_other_leg(upper, 0.086f), between(hip, knee, 0.3f),
                                beside_other_leg(upper, 0.08f)));
    shorts.parts.back().limb = left ? FigureLimb::kLeftLeg : FigureLimb::kRightLeg;
  }
}

void FigureBuilder::add_skirt() {
  const Vector3f left =
      between(places_.at(Bone::kLeftUpperLeg), places_.at(Bone::kLeftLowerLeg), 0.8f);
  const Vector3f right =
      between(places_.at(Bone::kRightUpperLeg), places_.at(Bone::kRightLowerLeg), 0.8f);
  const Vector3f seat = at(Bone::kHips, {0, -0.05f, -0.012f});
  FigureLayer& skirt = layer(Material::kLegs, 0.015f, 0.02f, FigureSkinning::kSkirt);
  const Vector3f hem = 0.5f * (left + right);
  skirt.hem_y_m = hem.y();
  skirt.parts.push_back(part(at(Bone::kHips, {0, 0.09f, 0}), 0.11f, seat, 0.148f, 1.2f, 0.97f));
  skirt.parts.push_back(
      part(seat, 0.148f, hem - places_.scale * 0.1f * Vector3f::UnitY(), 0.215f, 1.2f, 0.97f));
}

void FigureBuilder::add_shoe(Side side) {
  const bool left = side == Side::kLeft;
  const Bone foot = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const Bone toes = left ? Bone::kLeftToes : Bone::kRightToes;
  const Tip tip = left ? Tip::kLeftToes : Tip::kRightToes;
  const FigureLimb limb = left ? FigureLimb::kLeftLeg : FigureLimb::kRightLeg;
  // How far the sole lies below ankle and ball when the foot stands flat.
  const float under_ball_m = skeleton_.tip(tip).y() / places_.scale;
  const float under_ankle_m = skeleton_.offset(toes).y() / places_.scale + under_ball_m;
  // A thin sole, flush with the sides of the upper.
  constexpr float kSole_m = 0.007f;
  constexpr float kThin = 0.22f;
  constexpr float kSides_m = 0.02f;
  constexpr float kLow = 0.5f;
  const Vector3f toe_end = places_.at(tip);
  FigureLayer& shoe = layer(Material::kShoes, 0.01f, 0.015f);
  shoe.parts.push_back(part(at(foot, {0, under_ankle_m + 0.046f, -0.03f}), 0.036f,
                            at(foot, {0, -0.006f, -0.004f}), 0.041f));
  shoe.parts.push_back(part(at(foot, {0, -0.018f, 0.006f}), 0.038f,
                            at(toes, {0, under_ball_m + 0.034f, 0}), 0.031f, 1.12f));
  shoe.parts.push_back(part(at(toes, {0, under_ball_m + 0.033f, 0}), 0.031f,
                            toe_end + places_.scale * 0.026f * Vector3f::UnitY(), 0.02f, 1.25f));
  shoe.parts.push_back(part(at(foot, {0, under_ankle_m + kSides_m, -0.034f}), 0.034f,
                            at(toes, {0, under_ball_m + kSides_m, 0}), 0.036f, 1.04f, kLow));
  shoe.parts.push_back(part(at(toes, {0, under_ball_m + kSides_m, 0}), 0.036f,
                            toe_end + places_.scale * 0.018f * Vector3f::UnitY(), 0.024f, 1.04f,
                            kLow));
  FigureLayer& sole = layer(Material::kSoles, 0.011f, 0.006f);
  sole.parts.push_back(part(at(foot, {0, under_ankle_m + kSole_m, -0.034f}), 0.034f,
                            at(toes, {0, under_ball_m + kSole_m, 0}), 0.0355f, 1.04f, kThin));
  sole.parts.push_back(part(at(toes, {0, under_ball_m + kSole_m, 0}), 0.0355f,
                            toe_end + places_.scale * kSole_m * Vector3f::UnitY(), 0.0235f, 1.04f,
                            kThin));
  for (FigureLayer* each : {&layers_[layers_.size() - 2], &layers_.back()})
    for (FigurePart& part : each->parts) part.limb = limb;
}

}  // namespace dance
