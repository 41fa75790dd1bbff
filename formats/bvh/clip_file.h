// Loads a recorded dance from a BVH file, plain or packed with xz, onto the canonical skeleton.
//
// Units/frames: see formats/bvh/retarget.h: assumptions are returned as notes.
// Ownership:    plain values.
// Threads:      none inside; reads the file on the caller's thread.
// Failure:      an Error names the file (and the line, where one is broken) and the cure. A file
//               that ends early gives the frames up to there, and `lost`.
//               Compressed and decompressed size are both bounded.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "formats/bvh/retarget.h"

namespace dance {

constexpr std::size_t kLargestClipFile_bytes = std::size_t{1} << 30;

struct LoadedClip {
  MotionClip clip;
  std::vector<std::string> notes;
  std::string lost = {};  // as Bvh has it
};

Result<LoadedClip> load_clip(const std::string& path, const RetargetOptions& options = {});

// The bytes of a file, decompressed if it is an xz file. Refuses more than `most_bytes`, before and
// after decompression.
Result<std::string> read_clip_text(const std::string& path,
                                   std::size_t most_bytes = kLargestClipFile_bytes);

}  // namespace dance
