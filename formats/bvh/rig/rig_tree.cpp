#include "formats/bvh/rig/rig_tree.h"

#include <algorithm>

#include "formats/bvh/rig/rig.h"

namespace dance {
namespace {

constexpr double kShortestBone = 1e-4;  // of the figure's longest reach: 0.2 mm of a person

}  // namespace

RigTree::RigTree(const Bvh& bvh) : bvh_(bvh) {
  const std::size_t count = bvh.joints.size();
  children_.resize(count);
  depth_.resize(count, 0);
  reach_.resize(count, 0.0);
  rest_.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    rest_[j] = bvh.joints[j].offset;
    if (bvh.joints[j].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(bvh.joints[j].parent);
    children_[parent].push_back(static_cast<int>(j));
    depth_[j] = depth_[parent] + 1;
    rest_[j] += rest_[parent];
  }
  for (std::size_t j = count; j-- > 0;) {
    if (bvh.joints[j].end_site) reach_[j] = std::max(reach_[j], bvh.joints[j].end_site->norm());
    if (bvh.joints[j].parent < 0) continue;
    double& above = reach_[static_cast<std::size_t>(bvh.joints[j].parent)];
    above = std::max(above, reach_[j] + bvh.joints[j].offset.norm());
  }
  for (const double reach : reach_)
    shortest_bone_ = std::max(shortest_bone_, kShortestBone * reach);
}

bool RigTree::is_above(int ancestor, int joint) const {
  if (ancestor == kNoJoint) return false;
  while (joint != kNoJoint && joint != ancestor) joint = parent(joint);
  return joint == ancestor;
}

int RigTree::common_ancestor(int a, int b) const {
  while (a != kNoJoint && !is_above(a, b)) a = parent(a);
  return a;
}

std::vector<int> RigTree::path(int ancestor, int joint) const {
  std::vector<int> joints;
  for (; joint != kNoJoint && joint != ancestor; joint = parent(joint)) joints.push_back(joint);
  std::reverse(joints.begin(), joints.end());
  return joints;
}

std::vector<int> RigTree::longest_chain(int joint) const {
  std::vector<int> chain{joint};
  for (int at = joint; !children(at).empty();) {
    const auto& below = children(at);
    at = *std::max_element(below.begin(), below.end(), [this](int a, int b) {
      return length(a) + reach(a) < length(b) + reach(b);
    });
    if (length(at) < shortest_bone_)
      chain.back() = at;
    else
      chain.push_back(at);
  }
  return chain;
}

}  // namespace dance
