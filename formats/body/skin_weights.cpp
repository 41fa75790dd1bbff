#include "formats/body/skin_weights.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3f;

// The skin between neck and head bends over this much to both sides of a place below the joint.
constexpr float kNeckBend_m = 0.03f;

// 0 up to `from`, 1 from `to` on, smooth between.
float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// The four largest, as whole 255ths whose sum is 255.
SkinWeights quantised(const auto& shares) {
  std::array<std::size_t, 4> largest{};
  std::array<float, 4> values{};
  for (std::size_t joint = 0; joint < shares.size(); ++joint) {
    std::size_t j = joint;
    float value = shares[joint];
    for (std::size_t k = 0; k < 4; ++k)
      if (value > values[k]) {
        std::swap(value, values[k]);
        std::swap(j, largest[k]);
      }
  }
  float sum = 0.0f;
  for (const float value : values) sum += value;
  SkinWeights out;
  int left = 255;
  for (std::size_t k = 0; k < 4; ++k) {
    const int weight = static_cast<int>(std::lround(255.0f * values[k] / sum));
    out.weights[k] = static_cast<std::uint8_t>(std::min(left, weight));
    left -= out.weights[k];
  }
  out.weights[0] = static_cast<std::uint8_t>(out.weights[0] + left);
  for (std::size_t k = 0; k < 4; ++k)
    out.joints[k] = out.weights[k] > 0 ? static_cast<std::uint8_t>(largest[k]) : std::uint8_t{0};
  return out;
}

}  // namespace

SkinWeighting::SkinWeighting(const Skeleton& skeleton)
    : places_(skeleton), layout_(hand_layout(skeleton)) {}

float SkinWeighting::beyond(Bone bone, const Vector3f& direction, const Vector3f& place_m,
                            float half_m, float shift_m) const {
  const float along = (place_m - places_.at(bone)).dot(direction) / places_.scale - shift_m;
  return smooth_step(-half_m, half_m, along);
}

void SkinWeighting::share_trunk(const Vector3f& place_m, float share, Shares& shares) const {
  const Vector3f up = Vector3f::UnitY();
  const float aside_m = std::abs(place_m.x() - places_.at(Bone::kNeck).x()) / places_.scale;
  // Shoulders are as high as the neck's joint, and no part of it.
  const float slim = 1.0f - smooth_step(0.05f, 0.1f, aside_m);
  // Cloth bends at the waist, also where the back's first joint lies between the hips: there
  // trousers follow the hips.
  constexpr float kWaist_m = 0.09f;
  const float spine_m =
      (places_.at(Bone::kSpine).y() - places_.at(Bone::kHips).y()) / places_.scale;
  const float waist_m = std::max(0.0f, kWaist_m - spine_m);
  const std::array<std::pair<Bone, float>, 5> joints{
      {{Bone::kSpine, beyond(Bone::kSpine, up, place_m, 0.05f, waist_m)},
       {Bone::kChest, beyond(Bone::kChest, up, place_m, 0.05f)},
       {Bone::kUpperChest, beyond(Bone::kUpperChest, up, place_m, 0.05f)},
       {Bone::kNeck, slim * beyond(Bone::kNeck, up, place_m, 0.035f)},
       {Bone::kHead, slim * beyond(Bone::kHead, up, place_m, kNeckBend_m, -0.5f * kNeckBend_m)}}};
  Bone bone = Bone::kHips;
  for (const auto& [next, taken] : joints) {
    shares[index_of(bone)] += share * (1.0f - taken);
    share *= taken;
    bone = next;
  }
  shares[index_of(bone)] += share;
}

// Shares by height alone, so that the sides of a head follow no shoulder, however near it is.
void SkinWeighting::share_neck(const Vector3f& place_m, Shares& shares) const {
  constexpr float kShortestNeck_m = 0.06f;
  const Vector3f up = Vector3f::UnitY();
  const float neck_m = (places_.at(Bone::kHead).y() - places_.at(Bone::kNeck).y()) / places_.scale;
  // A neck's joint in the skull must not leave the chin with the chest.
  const float lower_m = std::min(0.0f, neck_m - kShortestNeck_m);
  const float neck = beyond(Bone::kNeck, up, place_m, 0.035f, lower_m);
  const float head = beyond(Bone::kHead, up, place_m, kNeckBend_m, -0.5f * kNeckBend_m);
  shares[index_of(Bone::kUpperChest)] += (1.0f - neck) * (1.0f - head);
  shares[index_of(Bone::kNeck)] += neck * (1.0f - head);
  shares[index_of(Bone::kHead)] += head;
}

// Gives what is left for the trunk.
float SkinWeighting::share_arm(const Vector3f& place_m, bool left, Shares& shares) const {
  const Bone shoulder = left ? Bone::kLeftShoulder : Bone::kRightShoulder;
  const Bone upper = left ? Bone::kLeftUpperArm : Bone::kRightUpperArm;
  const Bone lower = left ? Bone::kLeftLowerArm : Bone::kRightLowerArm;
  const Bone hand = left ? Bone::kLeftHand : Bone::kRightHand;
  const Vector3f out = left ? Vector3f(Vector3f::UnitX()) : Vector3f(-Vector3f::UnitX());
  const Vector3f from_joint = (place_m - places_.at(upper)) / places_.scale;
  // Arms of a captured figure may hang a little in its T-pose.
  const Vector3f arm_m = places_.at(hand) - places_.at(upper);
  const float slope = arm_m.dot(out) > 0.1f ? arm_m.y() / arm_m.dot(out) : 0.0f;
  const float fall = slope * std::max(0.0f, from_joint.dot(out));
  // Below the armpit a point beside the joint is of the ribs.
  const float height = smooth_step(-0.13f, -0.06f, from_joint.y() - fall);
  const float collar = height * beyond(shoulder, out, place_m, 0.045f, 0.04f);
  const float arm = height * beyond(upper, out, place_m, 0.055f);
  const float fore = beyond(lower, out, place_m, 0.045f);
  const float palm = beyond(hand, out, place_m, 0.03f);
  shares[index_of(shoulder)] += collar * (1.0f - arm);
  shares[index_of(upper)] += collar * arm * (1.0f - fore);
  shares[index_of(lower)] += collar * arm * fore * (1.0f - palm);
  shares[index_of(hand)] += collar * arm * fore * palm;
  return 1.0f - collar;
}

float SkinWeighting::share_leg(const Vector3f& place_m, bool left, float share,
                               Shares& shares) const {
  const Bone upper = left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg;
  const Bone lower = left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg;
  const Bone foot = left ? Bone::kLeftFoot : Bone::kRightFoot;
  const Bone toes = left ? Bone::kLeftToes : Bone::kRightToes;
  const Vector3f down = -Vector3f::UnitY();
  const float thigh = share * beyond(upper, down, place_m, 0.085f, 0.035f);
  const float shin = beyond(lower, down, place_m, 0.06f);
  const float ankle = beyond(foot, down, place_m, 0.035f, -0.005f);
  const float ball = beyond(toes, Vector3f::UnitZ(), place_m, 0.025f);
  shares[index_of(upper)] += thigh * (1.0f - shin);
  shares[index_of(lower)] += thigh * shin * (1.0f - ankle);
  shares[index_of(foot)] += thigh * shin * ankle * (1.0f - ball);
  shares[index_of(toes)] += thigh * shin * ankle * ball;
  return share - thigh;
}

void SkinWeighting::share_upper_body(const Vector3f& place_m, Shares& shares) const {
  const bool left = place_m.x() > places_.at(Bone::kUpperChest).x();
  share_trunk(place_m, share_arm(place_m, left, shares), shares);
}

void SkinWeighting::share_body(const Vector3f& place_m, Shares& shares) const {
  const float hips_y_m = places_.at(Bone::kHips).y();
  if (place_m.y() > hips_y_m + 0.06f * places_.scale) {
    share_upper_body(place_m, shares);
    return;
  }
  // Thighs are of one leg; between them the seat changes sides gradually.
  const float x_m = (place_m.x() - places_.at(Bone::kHips).x()) / places_.scale;
  const float y_m = (place_m.y() - places_.at(Bone::kLeftUpperLeg).y()) / places_.scale;
  const float half_m = 0.002f + 0.03f * smooth_step(-0.12f, -0.04f, y_m);
  const float left = smooth_step(-half_m, half_m, x_m);
  const float rest = share_leg(place_m, true, left, shares);
  shares[index_of(Bone::kHips)] += rest + share_leg(place_m, false, 1.0f - left, shares);
}

void SkinWeighting::share_skirt(const Vector3f& place_m, Shares& shares) const {
  const float x_m = (place_m.x() - places_.at(Bone::kHips).x()) / places_.scale;
  const float left = smooth_step(-0.13f, 0.13f, x_m);
  const float legs = 0.9f * beyond(Bone::kLeftUpperLeg, -Vector3f::UnitY(), place_m, 0.12f, 0.09f);
  shares[index_of(Bone::kHips)] += 1.0f - legs;
  shares[index_of(Bone::kLeftUpperLeg)] += legs * left;
  shares[index_of(Bone::kRightUpperLeg)] += legs * (1.0f - left);
}

void SkinWeighting::share_finger(const Vector3f& place_m, std::size_t finger,
                                 Shares& shares) const {
  const std::size_t first = finger * kBonesOfAFinger;
  const Bone hand = hand_of_finger_bone(first);
  std::size_t owner = index_of(hand);
  Vector3f joint_m = places_.at(hand);
  float share = 1.0f;
  for (std::size_t bone = 0; bone < kBonesOfAFinger; ++bone) {
    joint_m += layout_.offset_m[first + bone];
    const bool last = bone + 1 == kBonesOfAFinger;
    const Vector3f step = last ? layout_.tip_m[finger] : layout_.offset_m[first + bone + 1];
    const float half_m = 0.22f * step.norm();
    const float taken = smooth_step(-half_m, half_m, (place_m - joint_m).dot(step.normalized()));
    shares[owner] += share * (1.0f - taken);
    share *= taken;
    owner = kBoneCount + first + bone;
  }
  shares[owner] += share;
}

SkinWeights SkinWeighting::weights_at(const Vector3f& place_m, const FigureLayer& layer) const {
  Shares shares{};
  switch (layer.skinning) {
    case FigureSkinning::kBody:
      share_body(place_m, shares);
      break;
    case FigureSkinning::kTop:
      share_upper_body(place_m, shares);
      break;
    case FigureSkinning::kSkirt:
      share_skirt(place_m, shares);
      break;
    case FigureSkinning::kHead:
      shares[index_of(Bone::kHead)] = 1.0f;
      break;
    case FigureSkinning::kNeck:
      share_neck(place_m, shares);
      break;
    case FigureSkinning::kFinger:
      share_finger(place_m, layer.finger, shares);
      break;
  }
  return quantised(shares);
}

}  // namespace dance
