// What VRM 1.0 adds to a glTF file, as values of its JSON.
//
// Units/frames: as AvatarModel.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the model is sound.
// Source:       VRMC_vrm 1.0, VRMC_springBone 1.0, VRMC_materials_mtoon 1.0.
#pragma once

#include <vector>

#include "formats/avatar/avatar_model.h"
#include "formats/avatar/vrm_writer.h"
#include "formats/gltf/glb_values.h"

namespace dance {

// Where a written mesh lies in the file: the parts of one first-person kind, and their morphs.
struct VrmMesh {
  int node = 0;
  FirstPerson first_person = FirstPerson::kAuto;
  std::vector<std::uint32_t> morphs;  // of the model, by the index of the target
};

tinygltf::Value vrm_extension(const AvatarModel& model, const VrmMeta& meta,
                              const std::vector<VrmMesh>& meshes);
// `ends[i]` is the node at which the model's spring i ends.
tinygltf::Value spring_extension(const AvatarModel& model, const std::vector<int>& ends);
tinygltf::Value mtoon_extension(const AvatarMaterial& material);

}  // namespace dance
