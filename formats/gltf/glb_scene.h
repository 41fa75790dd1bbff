// The nodes of a glTF file as a tree that may be walked: every index is inside, each node has at
// most one parent, none is below itself.
//
// Units/frames: of the file: metres, +Y up; a node's transform is from its own to its parent's.
// Ownership:    owns its nodes.
// Threads:      none inside.
// Failure:      checked_scene() says which node is wrong.
#pragma once

#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "formats/gltf/glb.h"

namespace dance {

struct GlbTransform {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

struct GlbNode {
  std::string name;
  int parent = -1;
  std::vector<int> children;
  GlbTransform rest;
};

struct GlbScene {
  std::vector<GlbNode> nodes;
  std::vector<int> parents_first;  // every node, after its parent

  const GlbNode& at(int node) const { return nodes[static_cast<std::size_t>(node)]; }
};

Result<GlbScene> checked_scene(const tinygltf::Model& model, const GlbLimits& limits);

}  // namespace dance
