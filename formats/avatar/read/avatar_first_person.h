// Which meshes are drawn for the one who looks through the figure's eyes, as VRM tells it.
//
// Units/frames: nodes and meshes of the file.
// Ownership:    copies.
// Threads:      none inside; const use from any.
// Failure:      what is not told, or told wrongly, is kAuto.
// Source:       VRM 1.0 firstPerson (by node), VRM 0.x firstPerson (by mesh).
#pragma once

#include <tiny_gltf.h>

#include <map>

#include "formats/avatar/avatar_model.h"

namespace dance {

class AvatarFirstPerson {
 public:
  explicit AvatarFirstPerson(const tinygltf::Model& file);

  FirstPerson of(int node, int mesh) const;

 private:
  std::map<int, FirstPerson> of_node_;
  std::map<int, FirstPerson> of_mesh_;
};

}  // namespace dance
