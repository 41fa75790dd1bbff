// What VRM's extensions of a glTF file say about its nodes: which bone each is, so that an avatar's
// own names do not matter, and the same of our dancers for players of VRM animations.
//
// Threads: none inside.
// Failure: what is no bone or no node is left out.
// Source:  VRMC_vrm 1.0 and VRMC_vrm_animation 1.0 (humanoid.humanBones: name to node); VRM 0.x
//          (a list of bone and node, thumbs named as Unity does).
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <string>

namespace dance {

// VRM 1.0's bone of each node, eyes too; empty where the file has no such extension.
std::map<int, std::string> vrm_bones(const tinygltf::Model& model);

// Marks the one dancer of a file, whose joints' nodes begin at `first_node`, as a VRM animation.
void mark_vrm_animation(tinygltf::Model& model, int first_node, bool has_hands);

}  // namespace dance
