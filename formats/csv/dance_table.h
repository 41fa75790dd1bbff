// The columns of a dance as a table: what CsvConsumer writes and CsvReader reads. docs/files.md has
// them.
//
// Units/frames: as the names say; rotations in the parent bone, positions in W.
// Ownership:    returns new texts.
// Threads:      any.
// Failure:      none.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose/bone.h"

namespace dance {

// Groups of columns follow each other in this order.
struct TableColumns {
  static constexpr std::array<std::string_view, 8> kHead{"heard_us",   "capture_us", "clock_id",
                                                         "guest",      "sequence",   "presence",
                                                         "confidence", "music_beats"};
  static constexpr std::size_t kHips = kHead.size();                      // x, y, z
  static constexpr std::size_t kRotations = kHips + 3;                    // x, y, z, w of each bone
  static constexpr std::size_t kPositions = kRotations + 4 * kBoneCount;  // of all but the hips
  static constexpr std::size_t kTips = kPositions + 3 * (kBoneCount - 1);
  static constexpr std::size_t kHipsHeight = kTips + 3 * kTipCount;
  static constexpr std::size_t kCount = kHipsHeight + 1;
};

// As many as TableColumns::kCount.
inline std::vector<std::string> table_column_names() {
  std::vector<std::string> names(TableColumns::kHead.begin(), TableColumns::kHead.end());
  const auto add_xyz = [&](std::string_view what) {
    for (const char* axis : {"_x_m", "_y_m", "_z_m"}) names.push_back(std::string(what) + axis);
  };
  add_xyz(kBones[0].name);
  for (const BoneInfo& bone : kBones)
    for (const char* axis : {"_x", "_y", "_z", "_w"})
      names.push_back(std::string(bone.name) + axis);
  for (std::size_t bone = 1; bone < kBoneCount; ++bone) add_xyz(kBones[bone].name);
  for (const Bone bone : kTipBones) add_xyz(std::string(kBones[index_of(bone)].name) + "Tip");
  names.emplace_back("hips_height_m");
  return names;
}

}  // namespace dance
