#include "formats/bvh/rig/rig_check.h"

#include <algorithm>

namespace dance {
namespace {

// Bounds that figures of cartoons keep too.
constexpr double kApart = 0.02;         // of a leg, between left and right
constexpr double kMostUneven = 4.0;     // the longer of a limb's two bones beside the shorter
constexpr double kMostLopsided = 1.5;   // a limb beside that of the other side
constexpr double kSkippedOfLimb = 0.2;  // a bone on either side of a joint that is no helper

struct CheckedLimb {
  Bone upper, lower, end;
};
constexpr CheckedLimb kCheckedLimbs[][2] = {
    {{Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot},
     {Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot}},
    {{Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand},
     {Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kRightHand}}};

std::string name_of(Bone bone) { return std::string(kBones[index_of(bone)].name); }

class RigCheck {
 public:
  RigCheck(const RigTree& tree, const Rig& rig, const std::vector<bool>& may_skip)
      : tree_(tree), rig_(rig), may_skip_(may_skip) {}

  std::string fault() const {
    const double leg = way(Bone::kLeftUpperLeg, Bone::kLeftLowerLeg) +
                       way(Bone::kRightUpperLeg, Bone::kRightLowerLeg);
    for (const auto& [left, right] : kCheckedLimbs) {
      if (distance(left.upper, right.upper) <= kApart * leg)
        return name_of(left.upper) + " and " + name_of(right.upper) + " are in one place";
      for (const CheckedLimb& limb : {left, right})
        if (std::string fault = limb_fault(limb); !fault.empty()) return fault;
      const double left_length = length(left);
      const double right_length = length(right);
      if (std::max(left_length, right_length) > kMostLopsided * std::min(left_length, right_length))
        return name_of(left.upper) + " and " + name_of(right.upper) + " differ in length";
    }
    return {};
  }

 private:
  double distance(Bone a, Bone b) const {
    return (tree_.rest(rig_.joint(a)) - tree_.rest(rig_.joint(b))).norm();
  }
  double way(Bone from, Bone to) const {
    if (!rig_.has(from) || !rig_.has(to)) return 0.0;
    double sum = 0.0;
    for (const int joint : tree_.path(rig_.joint(from), rig_.joint(to))) sum += tree_.length(joint);
    return sum;
  }
  double length(const CheckedLimb& limb) const {
    return way(limb.upper, limb.lower) + way(limb.lower, limb.end);
  }

  std::string limb_fault(const CheckedLimb& limb) const {
    if (!tree_.is_above(rig_.joint(limb.upper), rig_.joint(limb.lower)))
      return name_of(limb.lower) + " is not below " + name_of(limb.upper);
    if (!rig_.has(limb.end)) return {};
    const double upper = way(limb.upper, limb.lower);
    const double lower = way(limb.lower, limb.end);
    if (std::max(upper, lower) > kMostUneven * std::min(upper, lower))
      return name_of(limb.upper) + " and " + name_of(limb.lower) + " differ in length";
    for (const auto& [from, to] : {std::pair{limb.upper, limb.lower}, {limb.lower, limb.end}})
      if (skips(from, to, upper + lower))
        return "a joint between " + name_of(from) + " and " + name_of(to) + " is skipped";
    return {};
  }

  bool skips(Bone from, Bone to, double limb) const {
    const std::vector<int> path = tree_.path(rig_.joint(from), rig_.joint(to));
    const double whole = way(from, to);
    double before = 0.0;
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
      const auto joint = static_cast<std::size_t>(path[i]);
      before += tree_.length(path[i]);
      const bool may = joint < may_skip_.size() && may_skip_[joint];
      if (!may && std::min(before, whole - before) > kSkippedOfLimb * limb) return true;
    }
    return false;
  }

  const RigTree& tree_;
  const Rig& rig_;
  const std::vector<bool>& may_skip_;
};

}  // namespace

std::string rig_fault(const RigTree& tree, const Rig& rig, const std::vector<bool>& may_skip) {
  return RigCheck(tree, rig, may_skip).fault();
}

}  // namespace dance
