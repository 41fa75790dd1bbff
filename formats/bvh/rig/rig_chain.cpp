#include "formats/bvh/rig/rig_chain.h"

#include <algorithm>

namespace dance {
namespace {

bool says_neck(const std::vector<bool>& is_neck, int joint) {
  return joint >= 0 && static_cast<std::size_t>(joint) < is_neck.size() &&
         is_neck[static_cast<std::size_t>(joint)];
}

// Of many spine joints the first, a middle and the last; the last carries the arms.
void place_spine(const std::vector<int>& spine, Rig& rig) {
  if (spine.empty()) return;
  rig[Bone::kSpine] = spine.front();
  if (spine.size() >= 2) rig[Bone::kChest] = spine[spine.size() == 2 ? 1 : spine.size() / 2];
  if (spine.size() >= 3) rig[Bone::kUpperChest] = spine.back();
}

// Above the arms' joint the branch that is no arm: neck and head, or a head alone.
int find_head(const RigTree& tree, int arms, int left_arm, int right_arm) {
  int best = kNoJoint;
  for (const int child : tree.children(arms)) {
    if (tree.is_above(child, left_arm) || tree.is_above(child, right_arm)) continue;
    if (best == kNoJoint ||
        tree.length(child) + tree.reach(child) > tree.length(best) + tree.reach(best))
      best = child;
  }
  if (best == kNoJoint) return kNoJoint;
  const std::vector<int> chain = tree.longest_chain(best);
  return chain[std::min<std::size_t>(1, chain.size() - 1)];
}

void place_head(const RigTree& tree, int arms, int head, const std::vector<bool>& is_neck,
                Rig& rig) {
  if (head == kNoJoint || !tree.is_above(arms, head) || head == arms) return;
  rig[Bone::kHead] = head;
  if (says_neck(is_neck, arms)) {
    rig[Bone::kNeck] = arms;  // 3ds Max hangs collar bones below the neck
    return;
  }
  std::vector<int> between = tree.path(arms, head);
  between.pop_back();
  if (between.empty()) return;
  const auto named = std::find_if(between.begin(), between.end(),
                                  [&](int joint) { return says_neck(is_neck, joint); });
  rig[Bone::kNeck] = named != between.end() ? *named : between.front();
}

}  // namespace

bool place_trunk(const RigTree& tree, int head, const std::vector<bool>& is_neck, Rig& rig) {
  const int left_thigh = rig.joint(Bone::kLeftUpperLeg);
  const int right_thigh = rig.joint(Bone::kRightUpperLeg);
  const auto arm_root = [&rig](Bone shoulder, Bone upper_arm) {
    return rig.has(shoulder) ? rig.joint(shoulder) : rig.joint(upper_arm);
  };
  const int left_arm = arm_root(Bone::kLeftShoulder, Bone::kLeftUpperArm);
  const int right_arm = arm_root(Bone::kRightShoulder, Bone::kRightUpperArm);
  if (left_thigh < 0 || right_thigh < 0 || left_arm < 0 || right_arm < 0) return false;

  const int hips = tree.common_ancestor(left_thigh, right_thigh);
  const int arms = tree.common_ancestor(left_arm, right_arm);
  const bool thighs_below = hips != kNoJoint && hips != left_thigh && hips != right_thigh;
  const bool arms_below = arms != kNoJoint && arms != left_arm && arms != right_arm;
  if (!thighs_below || !arms_below) return false;
  rig[Bone::kHips] = hips;

  // Some tools hang legs and spine side by side below a root: then the spine begins at the root.
  const int fork = tree.common_ancestor(hips, arms);
  std::vector<int> spine;
  for (const int joint : tree.path(fork, arms)) {
    if (joint == hips || says_neck(is_neck, joint)) continue;
    if (!spine.empty() && tree.length(joint) < tree.shortest_bone())
      spine.back() = joint;
    else
      spine.push_back(joint);
  }
  place_spine(spine, rig);

  if (head == kNoJoint) head = find_head(tree, arms, left_arm, right_arm);
  place_head(tree, arms, head, is_neck, rig);
  return true;
}

}  // namespace dance
