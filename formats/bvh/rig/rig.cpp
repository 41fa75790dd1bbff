#include "formats/bvh/rig/rig.h"

#include <algorithm>
#include <optional>

#include "formats/bvh/bvh_tokens.h"
#include "formats/bvh/rig/rig_chain.h"
#include "formats/bvh/rig/rig_check.h"
#include "formats/bvh/rig/rig_fingers.h"
#include "formats/bvh/rig/rig_names.h"
#include "formats/bvh/rig/rig_shape.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {
namespace {

constexpr Bone kNeededBones[] = {Bone::kHips,          Bone::kLeftUpperArm,  Bone::kLeftLowerArm,
                                 Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kLeftUpperLeg,
                                 Bone::kLeftLowerLeg,  Bone::kRightUpperLeg, Bone::kRightLowerLeg};
constexpr std::size_t kNamesShown = 8;

// The joint that is taken of several with the same name.
enum class NameChoice : std::uint8_t { kPlainest, kNearestToRoot, kDeepest };

class NamedJoints {
 public:
  explicit NamedJoints(const RigTree& tree) : tree_(tree) {
    std::vector<std::string_view> names;
    for (const BvhJoint& joint : tree.bvh().joints) names.push_back(joint.name);
    const std::string_view prefix = common_prefix(names);
    for (std::string_view name : names) {
      if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
      names_.push_back(read_rig_name(name));
    }
    resolve_numbered_fingers(names_);
  }

  void choose(NameChoice choice) { choice_ = choice; }

  // The joint with this name, below `above` (kNoJoint: anywhere).
  int pick(RigSide side, std::initializer_list<RigPart> parts, int above = kNoJoint) const {
    int best = kNoJoint;
    for (int j = 0; j < static_cast<int>(names_.size()); ++j) {
      const RigName& name = at(j);
      const bool wanted =
          name.side == side && std::find(parts.begin(), parts.end(), name.part) != parts.end();
      if (!wanted || (above != kNoJoint && (j == above || !tree_.is_above(above, j)))) continue;
      if (best == kNoJoint || is_better(j, best)) best = j;
    }
    return best;
  }

  // The joints of a finger, one below the other.
  std::vector<int> finger_chain(RigSide side, RigPart finger, int hand) const {
    std::vector<int> chain;
    for (int above = hand;;) {
      int next = kNoJoint;
      for (int j = above + 1; j < static_cast<int>(names_.size()); ++j) {
        const bool wanted = at(j).side == side && at(j).part == finger && tree_.is_above(above, j);
        if (wanted && (next == kNoJoint || tree_.depth(j) < tree_.depth(next))) next = j;
      }
      if (next == kNoJoint) return chain;
      chain.push_back(next);
      above = next;
    }
  }

  std::vector<bool> says(RigPart part) const {
    std::vector<bool> result;
    for (const RigName& name : names_) result.push_back(name.part == part);
    return result;
  }
  // Joints that a limb may have between its bones: helpers, and parts of one bone.
  std::vector<bool> may_skip(const Rig& rig) const {
    std::vector<bool> result = says(RigPart::kHelper);
    for (std::size_t j = 0; j < names_.size(); ++j)
      for (const int bone : rig.joint_of)
        if (bone != kNoJoint && bone != static_cast<int>(j) && names_[j].part != RigPart::kNone &&
            at(bone).part == names_[j].part && tree_.is_above(bone, static_cast<int>(j)))
          result[j] = true;
    return result;
  }
  bool is_helper(int joint) const { return at(joint).part == RigPart::kHelper; }
  bool has_number(int joint) const {
    const std::string& name = tree_.at(joint).name;
    return std::any_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
  }

 private:
  const RigName& at(int joint) const { return names_[static_cast<std::size_t>(joint)]; }
  bool is_better(int joint, int best) const {
    if (choice_ == NameChoice::kDeepest) return tree_.depth(joint) > tree_.depth(best);
    if (choice_ == NameChoice::kPlainest && at(joint).decoration != at(best).decoration)
      return at(joint).decoration < at(best).decoration;
    if (tree_.depth(joint) != tree_.depth(best)) return tree_.depth(joint) < tree_.depth(best);
    // Source's wrist is a helper beside the hand, which has the fingers.
    return tree_.reach(joint) > tree_.reach(best) + tree_.shortest_bone();
  }

  const RigTree& tree_;
  std::vector<RigName> names_;
  NameChoice choice_ = NameChoice::kPlainest;
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

void place_fingers(const RigTree& tree, const NamedJoints& named, RigSide side, Rig& rig) {
  constexpr RigPart kFingers[] = {RigPart::kThumb, RigPart::kIndex, RigPart::kMiddle,
                                  RigPart::kRing, RigPart::kLittle};
  const bool left = side == RigSide::kLeft;
  const int hand = rig.joint(left ? Bone::kLeftHand : Bone::kRightHand);
  if (hand == kNoJoint) return;
  std::size_t slot = left ? 0 : kFingerBoneCount / 2;
  for (const RigPart finger : kFingers) {
    const std::vector<int> chain = named.finger_chain(side, finger, hand);
    // "LeftHandIndex" above "LeftHandIndex1".
    const bool begins_with_palm = chain.size() > 3 && !named.has_number(chain.front()) &&
                                  std::all_of(chain.begin() + 1, chain.end(),
                                              [&](int joint) { return named.has_number(joint); });
    const auto bones =
        finger_bones_of(tree, hand, chain, finger == RigPart::kThumb, begins_with_palm);
    for (std::size_t phalanx = 0; phalanx < bones.size(); ++phalanx)
      rig.finger_of[slot + phalanx] = bones[phalanx];
    slot += 3;
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

Rig find_rig_by_names(const RigTree& tree, const NamedJoints& named) {
  Rig rig;
  for (const RigSide side : {RigSide::kLeft, RigSide::kRight}) {
    place_arm(tree, named, side, rig);
    place_leg(tree, named, side, rig);
    place_fingers(tree, named, side, rig);
  }
  int head = named.pick(RigSide::kMiddle, {RigPart::kHead});
  if (head == kNoJoint) {
    const int neck = named.pick(RigSide::kMiddle, {RigPart::kNeck});
    head = neck != kNoJoint ? next_along(tree, named, neck) : end_of_spine(tree, named, rig);
  }
  place_trunk(tree, head, named.says(RigPart::kNeck), rig);
  return rig;
}

// The first bone that two rigs have different joints for, in the words of a note.
std::string first_difference(const Bvh& bvh, const Rig& chosen, const Rig& other) {
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const int ours = chosen.joint_of[b];
    const int theirs = other.joint_of[b];
    if (ours == theirs || ours == kNoJoint || theirs == kNoJoint) continue;
    return std::string(kBones[b].name) + " is " +
           quoted(bvh.joints[static_cast<std::size_t>(ours)].name) + ", not " +
           quoted(bvh.joints[static_cast<std::size_t>(theirs)].name);
  }
  return {};
}

struct NamedRigs {
  std::optional<Rig> fitting;   // the first that is a human figure
  std::optional<Rig> complete;  // the first that has all needed bones
  std::string fault;            // of `complete`
  std::vector<std::string> missing;
};

NamedRigs rigs_by_names(const RigTree& tree) {
  NamedJoints named(tree);
  NamedRigs rigs;
  named.choose(NameChoice::kNearestToRoot);
  const Rig nearest = find_rig_by_names(tree, named);
  for (const NameChoice choice :
       {NameChoice::kPlainest, NameChoice::kNearestToRoot, NameChoice::kDeepest}) {
    named.choose(choice);
    Rig rig = find_rig_by_names(tree, named);
    std::vector<std::string> missing = missing_bones(rig);
    if (rigs.missing.empty() || missing.size() < rigs.missing.size()) rigs.missing = missing;
    if (!missing.empty()) continue;
    std::string fault = rig_fault(tree, rig, named.may_skip(rig));
    if (fault.empty()) {
      if (const std::string difference = first_difference(tree.bvh(), rig, nearest);
          !difference.empty())
        rig.assumption = "several joints are named as one bone: " + difference;
      rigs.fitting = std::move(rig);
      return rigs;
    }
    if (rigs.complete) continue;
    rigs.complete = std::move(rig);
    rigs.fault = std::move(fault);
  }
  return rigs;
}

std::string no_figure(const Bvh& bvh, const std::vector<std::string>& missing) {
  std::string what = "no human figure: no joint found for ";
  for (std::size_t i = 0; i < missing.size(); ++i) what += (i > 0 ? ", " : "") + missing[i];
  what += " among " + std::to_string(bvh.joints.size()) + " joints (";
  for (std::size_t i = 0; i < std::min(kNamesShown, bvh.joints.size()); ++i)
    what += (i > 0 ? ", " : "") + quoted(bvh.joints[i].name);
  what += bvh.joints.size() > kNamesShown ? ", ...)" : ")";
  return what + "; name them as Mixamo, CMU or VRM do";
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
  NamedRigs named = rigs_by_names(tree);
  if (named.fitting) return std::move(*named.fitting);
  auto shaped = find_rig_by_shape(tree);
  const bool is_figure = shaped && missing_bones(*shaped).empty();
  if (is_figure && (!named.complete || rig_fault(tree, *shaped, {}).empty())) {
    shaped->assumption = named.complete
                             ? "joint names give no human figure, as " + named.fault +
                                   ": bones found by the figure's shape"
                             : "joint names say nothing: bones found by the figure's shape";
    return std::move(*shaped);
  }
  if (named.complete) {
    named.complete->assumption =
        "joints taken by their names, although " + named.fault + "; check the result";
    return std::move(*named.complete);
  }
  return fail(no_figure(bvh, named.missing));
}

}  // namespace dance
