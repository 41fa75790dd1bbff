#include "producers/vmc/vmc_body.h"

#include <algorithm>
#include <cmath>

#include "core/pose/kinematics.h"

namespace dance {
namespace {

// Below this a position is none.
constexpr float kNoPlace_m = 1e-3f;
// A change below this is noise of the sender, not another body.
constexpr float kSameBody_m = 5e-3f;
constexpr float kLongestBone_m = 1.0f;
// Hips of children and giants.
constexpr float kLowestHips_m = 0.3f;
constexpr float kHighestHips_m = 1.6f;
// Hips that low are no dancer's, but a sender's that does not know where they are.
constexpr float kNoHips_m = 0.1f;
constexpr float kHeightStep_m = 0.02f;

// VRM demands these; the others' parents stand in where they lack.
constexpr std::array<Bone, 11> kNeededBones{
    Bone::kSpine,    Bone::kHead,          Bone::kLeftUpperArm, Bone::kLeftLowerArm,
    Bone::kLeftHand, Bone::kRightUpperArm, Bone::kLeftUpperLeg, Bone::kLeftLowerLeg,
    Bone::kLeftFoot, Bone::kRightUpperLeg, Bone::kRightFoot};

float largest_change_m(const Skeleton& a, const Skeleton& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    largest = std::max(largest, (a.offset_m[i] - b.offset_m[i]).norm());
  return largest;
}

float sole_below_ankle_m(const Skeleton& skeleton) {
  return std::max(0.0f, -skeleton.offset(Bone::kLeftToes).y() - skeleton.tip(Tip::kLeftToes).y());
}

}  // namespace

void VmcBody::take(const ReceivedVmcFrame& frame) {
  // X_WH = X_WRoot X_RootH
  pose_.p_WH_m = frame.root_p_m + frame.root_R * frame.p_m[0];
  for (std::size_t i = 0; i < kBoneCount; ++i) pose_.R_PB[i] = frame.R[i];
  pose_.R_PB[0] = (frame.root_R * frame.R[0]).normalized();
  pose_.presence = static_cast<std::uint32_t>(frame.bones) & kAllBones;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) hands_.R_PB[i] = frame.R[kBoneCount + i];
  hands_.presence = static_cast<std::uint32_t>(frame.bones >> kBoneCount);

  const bool has_place = frame.p_m[0].norm() > kNoPlace_m;
  const float height_m = pose_.p_WH_m.y();
  has_own_proportions_ = learn_proportions(frame);
  if (!has_own_proportions_ && has_place) guess_height(height_m);
  if (!has_place && height_m < kNoHips_m) stand_on_the_floor();
}

bool VmcBody::learn_proportions(const ReceivedVmcFrame& frame) {
  const auto came = [&](Bone bone) { return ((frame.ever >> index_of(bone)) & 1u) != 0; };
  for (const Bone bone : kNeededBones)
    if (!came(bone) || frame.p_m[index_of(bone)].norm() < kNoPlace_m) return has_own_proportions_;
  Skeleton learnt = average_skeleton();
  float legs_m = 0.0f;
  for (std::size_t i = 1; i < kBoneCount; ++i) {
    const bool is_toes = i == index_of(Bone::kLeftToes) || i == index_of(Bone::kRightToes);
    if (((frame.ever >> i) & 1u) != 0)
      learnt.offset_m[i] = frame.p_m[i];
    else if (!is_toes)
      learnt.offset_m[i].setZero();
    if (learnt.offset_m[i].norm() > kLongestBone_m) return has_own_proportions_;
  }
  for (const Bone bone : {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot})
    legs_m -= learnt.offset(bone).y();
  const float scale = legs_m / (learnt.hips_height_m() - sole_below_ankle_m(learnt));
  if (!(scale > 0.1f && scale < 2.0f)) return has_own_proportions_;
  for (auto& tip_m : learnt.tip_m) tip_m *= scale;
  for (const Bone toes : {Bone::kLeftToes, Bone::kRightToes})
    if (!came(toes)) learnt.offset_m[index_of(toes)] *= scale;
  learnt.offset_m[0] = {0.0f, legs_m + sole_below_ankle_m(learnt), 0.0f};
  if (!has_own_proportions_ || largest_change_m(learnt, skeleton_) > kSameBody_m)
    skeleton_ = learnt;
  return true;
}

void VmcBody::guess_height(float hips_height_m) {
  if (!(hips_height_m > kLowestHips_m && hips_height_m < kHighestHips_m)) return;
  if (hips_height_m < highest_hips_m_ + kHeightStep_m) return;
  highest_hips_m_ = hips_height_m;
  const Skeleton usual = average_skeleton();
  skeleton_ = average_skeleton(standing_height_m(usual) * hips_height_m / usual.hips_height_m());
}

void VmcBody::stand_on_the_floor() {
  BodyFrames frames;
  forward_kinematics(skeleton_, pose_, frames);
  const float lowest_m =
      std::min({frames.position(Bone::kLeftFoot).y() - sole_below_ankle_m(skeleton_),
                frames.position(Bone::kRightFoot).y() - sole_below_ankle_m(skeleton_),
                frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y()});
  pose_.p_WH_m.y() -= lowest_m;
}

}  // namespace dance
