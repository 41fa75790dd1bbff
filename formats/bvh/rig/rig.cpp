#include "formats/bvh/rig/rig.h"

#include <algorithm>

#include "formats/bvh/bvh_tokens.h"
#include "formats/bvh/rig/rig_chain.h"
#include "formats/bvh/rig/rig_names.h"
#include "formats/bvh/rig/rig_shape.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {
namespace {

constexpr Bone kNeededBones[] = {Bone::kHips,          Bone::kLeftUpperArm,  Bone::kLeftLowerArm,
                                 Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kLeftUpperLeg,
                                 Bone::kLeftLowerLeg,  Bone::kRightUpperLeg, Bone::kRightLowerLeg};
constexpr std::size_t kNamesShown = 8;

class NamedJoints {
 public:
  explicit NamedJoints(const RigTree& tree) : tree_(tree) {
    std::vector<std::string_view> names;
    for (const BvhJoint& joint : tree.bvh().joints) names.push_back(joint.name);
    const std::size_t prefix = common_prefix(names).size();
    for (std::string_view name : names) names_.push_back(read_rig_name(name.substr(prefix)));
  }

  // The joint with this name that is nearest to the root, below `above` (kNoJoint: anywhere).
  int pick(RigSide side, std::initializer_list<RigPart> parts, int above = kNoJoint) const {
    int best = kNoJoint;
    for (int j = 0; j < static_cast<int>(names_.size()); ++j) {
      const RigName& name = names_[static_cast<std::size_t>(j)];
      const bool wanted =
          name.side == side && std::find(parts.begin(), parts.end(), name.part) != parts.end();
      if (!wanted || (above != kNoJoint && (j == above || !tree_.is_above(above, j)))) continue;
      if (best == kNoJoint || tree_.depth(j) < tree_.depth(best)) best = j;
    }
    return best;
  }

  std::vector<bool> says(RigPart part) const {
    std::vector<bool> result;
    for (const RigName& name : names_) result.push_back(name.part == part);
    return result;
  }
  bool is_helper(int joint) const {
    return names_[static_cast<std::size_t>(joint)].part == RigPart::kHelper;
  }

 private:
  const RigTree& tree_;
  std::vector<RigName> names_;
};

// The joint after `joint` on the way to the furthest end below it.
int next_along(const RigTree& tree, const NamedJoints& named, int joint) {
  const std::vector<int> chain = tree.longest_chain(joint);
  for (std::size_t i = 1; i < chain.size(); ++i)
    if (!named.is_helper(chain[i])) return chain[i];
  return kNoJoint;
}

void place_arm(const RigTree& tree, const NamedJoints& named, RigSide side, Rig& rig) {
  const bool left = side == RigSide::kLeft;
  int collar = named.pick(side, {RigPart::kCollar});
  int upper = named.pick(side, {RigPart::kUpperArm});
  int lower = named.pick(side, {RigPart::kLowerArm});
  const int arm = named.pick(side, {RigPart::kArm});
  const int shoulder = named.pick(side, {RigPart::kShoulder});
  if (upper == kNoJoint && arm != kNoJoint && (lower != kNoJoint || shoulder == kNoJoint))
    upper = arm;
  else if (upper == kNoJoint && shoulder != kNoJoint)
    upper = shoulder;
  if (lower == kNoJoint && arm != upper) lower = arm;
  if (collar == kNoJoint && shoulder != upper) collar = shoulder;
  if (upper == kNoJoint) return;
  if (lower == kNoJoint || !tree.is_above(upper, lower)) lower = next_along(tree, named, upper);
  if (collar != kNoJoint && !tree.is_above(collar, upper)) collar = kNoJoint;
  rig[left ? Bone::kLeftShoulder : Bone::kRightShoulder] = collar;
  rig[left ? Bone::kLeftUpperArm : Bone::kRightUpperArm] = upper;
  rig[left ? Bone::kLeftLowerArm : Bone::kRightLowerArm] = lower;
  if (lower == kNoJoint) return;
  int hand = named.pick(side, {RigPart::kWrist, RigPart::kHand}, lower);
  if (hand == kNoJoint) hand = next_along(tree, named, lower);
  rig[left ? Bone::kLeftHand : Bone::kRightHand] = hand;
}

void place_leg(const RigTree& tree, const NamedJoints& named, RigSide side, Rig& rig) {
  const bool left = side == RigSide::kLeft;
  int thigh = named.pick(side, {RigPart::kThigh});
  int shin = named.pick(side, {RigPart::kShin});
  const int leg = named.pick(side, {RigPart::kLeg});
  if (thigh == kNoJoint) thigh = named.pick(side, {RigPart::kHip});
  if (thigh == kNoJoint) thigh = leg;
  if (shin == kNoJoint && leg != thigh) shin = leg;
  if (thigh == kNoJoint) return;
  if (shin == kNoJoint || !tree.is_above(thigh, shin)) shin = next_along(tree, named, thigh);
  rig[left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg] = thigh;
  rig[left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg] = shin;
  if (shin == kNoJoint) return;
  int foot = named.pick(side, {RigPart::kAnkle, RigPart::kFoot}, shin);
  if (foot == kNoJoint) foot = next_along(tree, named, shin);
  rig[left ? Bone::kLeftFoot : Bone::kRightFoot] = foot;
  if (foot == kNoJoint) return;
  // SMPL calls its toes "foot", below the ankle.
  rig[left ? Bone::kLeftToes : Bone::kRightToes] =
      named.pick(side, {RigPart::kToes, RigPart::kFoot}, foot);
}

void place_fingers(const NamedJoints& named, RigSide side, Rig& rig) {
  constexpr RigPart kFingers[] = {RigPart::kThumb, RigPart::kIndex, RigPart::kMiddle,
                                  RigPart::kRing, RigPart::kLittle};
  const bool left = side == RigSide::kLeft;
  const int hand = rig.joint(left ? Bone::kLeftHand : Bone::kRightHand);
  if (hand == kNoJoint) return;
  std::size_t slot = left ? 0 : kFingerBoneCount / 2;
  for (const RigPart finger : kFingers) {
    int above = hand;
    for (int phalanx = 0; phalanx < 3; ++phalanx, ++slot) {
      if (above == kNoJoint) continue;
      above = named.pick(side, {finger}, above);
      // The fourth joint that some tools write is the finger's tip.
      rig.finger_of[slot] = above;
    }
  }
}

// Rigify numbers the spine up to the head: of its joints above the arms the last.
int end_of_spine(const RigTree& tree, const NamedJoints& named, const Rig& rig) {
  const int left = rig.joint(Bone::kLeftUpperArm);
  const int right = rig.joint(Bone::kRightUpperArm);
  if (left == kNoJoint || right == kNoJoint) return kNoJoint;
  const int arms = tree.common_ancestor(left, right);
  const std::vector<bool> is_spine = named.says(RigPart::kSpine);
  int last = kNoJoint;
  int count = 0;
  for (int j = 0; j < static_cast<int>(is_spine.size()); ++j) {
    if (!is_spine[static_cast<std::size_t>(j)] || arms == kNoJoint || j == arms ||
        !tree.is_above(arms, j) || tree.is_above(j, left) || tree.is_above(j, right))
      continue;
    ++count;
    if (last == kNoJoint || tree.depth(j) > tree.depth(last)) last = j;
  }
  return count >= 2 ? last : kNoJoint;
}

Rig find_rig_by_names(const RigTree& tree) {
  const NamedJoints named(tree);
  Rig rig;
  for (const RigSide side : {RigSide::kLeft, RigSide::kRight}) {
    place_arm(tree, named, side, rig);
    place_leg(tree, named, side, rig);
    place_fingers(named, side, rig);
  }
  int head = named.pick(RigSide::kMiddle, {RigPart::kHead});
  if (head == kNoJoint) {
    const int neck = named.pick(RigSide::kMiddle, {RigPart::kNeck});
    head = neck != kNoJoint ? next_along(tree, named, neck) : end_of_spine(tree, named, rig);
  }
  place_trunk(tree, head, named.says(RigPart::kNeck), rig);
  return rig;
}

}  // namespace

std::vector<std::string> missing_bones(const Rig& rig) {
  std::vector<std::string> missing;
  for (const Bone bone : kNeededBones)
    if (!rig.has(bone)) missing.emplace_back(kBones[index_of(bone)].name);
  return missing;
}

Result<Rig> find_rig(const Bvh& bvh) {
  const RigTree tree(bvh);
  const Rig named = find_rig_by_names(tree);
  std::vector<std::string> missing = missing_bones(named);
  if (missing.empty()) return named;
  if (const auto shaped = find_rig_by_shape(tree); shaped && missing_bones(*shaped).empty())
    return *shaped;
  std::string what = "no human figure: no joint found for ";
  for (std::size_t i = 0; i < missing.size(); ++i) what += (i > 0 ? ", " : "") + missing[i];
  what += " among " + std::to_string(bvh.joints.size()) + " joints (";
  for (std::size_t i = 0; i < std::min(kNamesShown, bvh.joints.size()); ++i)
    what += (i > 0 ? ", " : "") + quoted(bvh.joints[i].name);
  what += bvh.joints.size() > kNamesShown ? ", ...)" : ")";
  return fail(what + "; name them as Mixamo, CMU or VRM do");
}

}  // namespace dance
