#include "core/pose/skeleton.h"

namespace dance {
namespace {

// Offsets of a body 1.72 m tall, metres, +X is the dancer's left. Segment lengths after Winter,
// Biomechanics and Motor Control of Human Movement (2009), table of segment length / body height;
// spine shared out evenly.
constexpr float kReferenceHeight_m = 1.72f;
constexpr float kOffsets[kBoneCount][3] = {
    {0.0f, 0.935f, 0.0f},      // hips: height above the floor
    {0.0f, 0.100f, -0.010f},   // spine
    {0.0f, 0.115f, -0.005f},   // chest
    {0.0f, 0.125f, 0.0f},      // upperChest
    {0.0f, 0.135f, -0.010f},   // neck
    {0.0f, 0.090f, 0.015f},    // head
    {0.030f, 0.090f, 0.0f},    // leftShoulder
    {0.145f, 0.0f, -0.010f},   // leftUpperArm
    {0.285f, 0.0f, 0.0f},      // leftLowerArm
    {0.250f, 0.0f, 0.0f},      // leftHand
    {-0.030f, 0.090f, 0.0f},   // rightShoulder
    {-0.145f, 0.0f, -0.010f},  // rightUpperArm
    {-0.285f, 0.0f, 0.0f},     // rightLowerArm
    {-0.250f, 0.0f, 0.0f},     // rightHand
    {0.095f, -0.040f, 0.0f},   // leftUpperLeg
    {0.0f, -0.415f, 0.0f},     // leftLowerLeg
    {0.0f, -0.400f, -0.020f},  // leftFoot
    {0.0f, -0.060f, 0.140f},   // leftToes
    {-0.095f, -0.040f, 0.0f},  // rightUpperLeg
    {0.0f, -0.415f, 0.0f},     // rightLowerLeg
    {0.0f, -0.400f, -0.020f},  // rightFoot
    {0.0f, -0.060f, 0.140f},   // rightToes
};
constexpr float kTips[kTipCount][3] = {
    {0.0f, 0.220f, 0.0f},   // top of the head
    {0.185f, 0.0f, 0.0f},   // left finger tips
    {-0.185f, 0.0f, 0.0f},  // right finger tips
    {0.0f, -0.020f, 0.070f}, {0.0f, -0.020f, 0.070f},
};
constexpr float kLongestBone_m = 2.0f;

}  // namespace

Skeleton average_skeleton(float height_m) {
  const float scale = height_m / kReferenceHeight_m;
  Skeleton skeleton;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    skeleton.offset_m[i] = scale * Eigen::Vector3f(kOffsets[i][0], kOffsets[i][1], kOffsets[i][2]);
  for (std::size_t i = 0; i < kTipCount; ++i)
    skeleton.tip_m[i] = scale * Eigen::Vector3f(kTips[i][0], kTips[i][1], kTips[i][2]);
  return skeleton;
}

bool is_valid(const Skeleton& skeleton) {
  const auto is_bone = [](const Eigen::Vector3f& v) {
    return v.allFinite() && v.squaredNorm() <= kLongestBone_m * kLongestBone_m;
  };
  for (const auto& v : skeleton.offset_m)
    if (!is_bone(v)) return false;
  for (const auto& v : skeleton.tip_m)
    if (!is_bone(v)) return false;
  return true;
}

float standing_height_m(const Skeleton& skeleton) {
  float height = skeleton.tip(Tip::kHead).y();
  for (int bone = static_cast<int>(index_of(Bone::kHead)); bone >= 0;
       bone = kBones[static_cast<std::size_t>(bone)].parent)
    height += skeleton.offset_m[static_cast<std::size_t>(bone)].y();
  return height;
}

}  // namespace dance
