#include "producers/natnet/natnet_body.h"

namespace dance {
namespace {

constexpr float kSamePlace_m = 0.02f;
// Shorter offsets say nothing.
constexpr float kLeastOffset_m = 0.03f;

}  // namespace

// A global place is another than the offset for nearly all bones, wherever the dancer is.
bool NatNetBody::looks_in_parents() const {
  int told = 0, same = 0;
  for (std::size_t i = 0; i < rig_.parts.size(); ++i) {
    const NatNetRig::Part& part = rig_.parts[i];
    if (part.parent == NatNetRig::kNone || !joints_[i].is_tracked) continue;
    if (part.offset_m.norm() < kLeastOffset_m) continue;
    ++told;
    if ((joints_[i].p_m - part.offset_m).norm() < kSamePlace_m) ++same;
  }
  return told > 0 && 4 * same > 3 * told;
}

void NatNetBody::make_global() {
  for (std::size_t i = 0; i < rig_.parts.size(); ++i) {
    const std::int16_t parent = rig_.parts[i].parent;
    if (parent == NatNetRig::kNone || !joints_[i].is_tracked) continue;
    const Joint& above = joints_[static_cast<std::size_t>(parent)];
    joints_[i].is_tracked = above.is_tracked;
    joints_[i].p_m = above.p_m + above.R * joints_[i].p_m;
    joints_[i].R = (above.R * joints_[i].R).normalized();
  }
}

void NatNetBody::take(const NatNetSkeleton& skeleton, bool z_is_up) {
  for (Joint& joint : joints_) joint.is_tracked = false;
  for (const NatNetBone& bone : skeleton.bones) {
    const std::int16_t part = rig_.part_of(bone.id);
    if (part == NatNetRig::kNone) continue;
    joints_[static_cast<std::size_t>(part)] = {bone.p_m, bone.R, bone.is_tracked};
  }
  is_in_parents_ = looks_in_parents();
  if (is_in_parents_) make_global();
  figure_ = FigureFrame();
  for (std::size_t i = 0; i < rig_.parts.size(); ++i) {
    const NatNetRig::Part& part = rig_.parts[i];
    Joint& joint = joints_[i];
    if (!joint.is_tracked) continue;
    if (z_is_up) {
      joint.p_m = {joint.p_m.x(), joint.p_m.z(), -joint.p_m.y()};
      joint.R = Eigen::Quaternionf(joint.R.w(), joint.R.x(), joint.R.z(), -joint.R.y());
    }
    if (part.bone != NatNetRig::kNone)
      figure_.put(static_cast<Bone>(part.bone), joint.p_m, joint.R);
  }
}

bool NatNetBody::hands(Hands& hands) const {
  hands.presence = 0;
  std::array<Eigen::Quaternionf, kFingerBoneCount> R_W;
  for (std::size_t i = 0; i < rig_.parts.size(); ++i) {
    const std::int16_t finger = rig_.parts[i].finger_bone;
    if (finger == NatNetRig::kNone || !joints_[i].is_tracked) continue;
    R_W[static_cast<std::size_t>(finger)] = joints_[i].R;
    hands.presence |= 1u << finger;
  }
  const std::uint32_t came = hands.presence;
  hands.presence = 0;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    if ((came >> f & 1u) == 0) continue;
    const int parent = kFingerBones[f].parent;
    if (parent >= 0 && (hands.presence >> parent & 1u) == 0) continue;
    const Bone hand = f < kFingerBoneCount / 2 ? Bone::kLeftHand : Bone::kRightHand;
    const Eigen::Quaternionf& R_WP =
        parent >= 0 ? R_W[static_cast<std::size_t>(parent)] : figure_.R_WB[index_of(hand)];
    hands.R_PB[f] = (R_WP.conjugate() * R_W[f]).normalized();
    hands.presence |= 1u << f;
  }
  return hands.presence != 0;
}

}  // namespace dance
