#include "formats/osc/average_hand.h"

namespace dance {
namespace {

constexpr float kHandLength_m = 0.185f;  // wrist to finger tips, of which the table is
constexpr std::size_t kBonesOfAHand = kFingerBoneCount / 2;
// The left hand's; order of kFingerBones.
constexpr float kOffsets[kBonesOfAHand][3] = {
    {0.022f, -0.010f, 0.020f},  {0.036f, -0.006f, 0.028f}, {0.028f, -0.002f, 0.015f},  // thumb
    {0.092f, 0.0f, 0.025f},     {0.040f, 0.0f, 0.0f},      {0.022f, 0.0f, 0.0f},       // index
    {0.090f, 0.003f, 0.002f},   {0.045f, 0.0f, 0.0f},      {0.026f, 0.0f, 0.0f},       // middle
    {0.084f, 0.0f, -0.018f},    {0.041f, 0.0f, 0.0f},      {0.026f, 0.0f, 0.0f},       // ring
    {0.076f, -0.004f, -0.036f}, {0.033f, 0.0f, 0.0f},      {0.018f, 0.0f, 0.0f},       // little
};

}  // namespace

FingerOffsets average_hand(const Skeleton& skeleton) {
  FingerOffsets offsets_m;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    const bool is_left = i < kBonesOfAHand;
    const float* own = kOffsets[i % kBonesOfAHand];
    const Tip tip = is_left ? Tip::kLeftHand : Tip::kRightHand;
    const float scale = skeleton.tip(tip).norm() / kHandLength_m;
    offsets_m[i] = scale * Eigen::Vector3f(is_left ? own[0] : -own[0], own[1], own[2]);
  }
  return offsets_m;
}

}  // namespace dance
