// The kinds of files that hold dances, by the ends of their names, in any case.
//
// Units/frames: none.
// Ownership:    returns new texts.
// Threads:      any.
// Failure:      an unknown end is an Error that lists the known ones.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

enum class FileKind { kLcm, kBvh, kGlb, kMcap, kCsv };

Result<FileKind> input_kind(const std::string& path);
Result<FileKind> output_kind(const std::string& path);

// A guest id made of a file's or a figure's name: "Dance 7.bvh.xz" is dance-7.
std::string guest_name_of(std::string name);

}  // namespace dance
