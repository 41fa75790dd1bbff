// A figure as a VRM 1.0 file: a GLB whose extensions say which node is which bone, how its face and
// its hair move, and who may use it.
//
// Units/frames: as AvatarModel, which are those of VRM 1.0.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      write_vrm() of a figure that is not sound, or that lacks what VRM 1.0 insists on
//               (a spine, a name, an author), says which.
// Source:       Khronos glTF 2.0; VRMC_vrm 1.0, VRMC_springBone 1.0, VRMC_materials_mtoon 1.0,
//               KHR_materials_unlit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "formats/avatar/avatar_model.h"

namespace dance {

struct VrmMeta {
  std::string name;  // "" = the model's
  std::string version = "1";
  std::vector<std::string> authors;
  std::string copyright;
  // Beside VRM's own terms, which every VRM 1.0 file refers to.
  std::string licence_url;
  bool is_for_everyone = true;        // else only its authors may be seen in it
  bool allows_redistribution = true;  // also of changed ones
  bool allows_commercial_use = true;
  bool needs_credit = false;
};

Result<std::vector<std::uint8_t>> write_vrm(const AvatarModel& model, const VrmMeta& meta);

}  // namespace dance
