// The joints of a file as a tree, for finding bones in it: children, depths, ancestors and how far
// each branch reaches.
//
// Units/frames: lengths in the file's units, of its OFFSETs.
// Ownership:    keeps a reference to the Bvh, which must outlive it.
// Threads:      none inside.
// Failure:      none; kNoJoint stands for "no such joint".
#pragma once

#include <vector>

#include "formats/bvh/bvh.h"

namespace dance {

class RigTree {
 public:
  explicit RigTree(const Bvh& bvh);

  const Bvh& bvh() const { return bvh_; }
  const BvhJoint& at(int joint) const { return bvh_.joints[static_cast<std::size_t>(joint)]; }
  std::size_t size() const { return bvh_.joints.size(); }
  int parent(int joint) const { return at(joint).parent; }
  int depth(int joint) const { return depth_[static_cast<std::size_t>(joint)]; }
  const std::vector<int>& children(int joint) const {
    return children_[static_cast<std::size_t>(joint)];
  }
  double length(int joint) const { return at(joint).offset.norm(); }
  // Along the bones from a joint to the furthest end below it.
  double reach(int joint) const { return reach_[static_cast<std::size_t>(joint)]; }
  // Joints in the same place count as one: the shortest length of a bone.
  double shortest_bone() const { return shortest_bone_; }

  // True also where both are the same joint.
  bool is_above(int ancestor, int joint) const;
  int common_ancestor(int a, int b) const;
  // From below `ancestor` down to `joint`, without the first and with the second.
  std::vector<int> path(int ancestor, int joint) const;
  // The way to the furthest end, from `joint` on; of joints in one place only the last.
  std::vector<int> longest_chain(int joint) const;
  // Places of joints with no joint turned.
  const Eigen::Vector3d& rest(int joint) const { return rest_[static_cast<std::size_t>(joint)]; }

 private:
  const Bvh& bvh_;
  std::vector<std::vector<int>> children_;
  std::vector<int> depth_;
  std::vector<double> reach_;
  std::vector<Eigen::Vector3d> rest_;
  double shortest_bone_ = 0.0;
};

}  // namespace dance
