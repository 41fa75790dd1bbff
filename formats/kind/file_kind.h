// The kinds of files that hold dances. A file to read is known by its content, and by the end of
// its name only where the content does not tell; a file to write by the end of its name, in any
// case.
//
// Failure:      an Error names the file and what it is, or lists the known ends.
#pragma once

#include <string>

#include "core/base/result.h"

namespace dance {

enum class FileKind { kLcm, kBvh, kGlb, kMcap, kCsv };

// The Error for a file that holds something else names its kind and the command that takes it.
Result<FileKind> input_kind(const std::string& path);
Result<FileKind> output_kind(const std::string& path);

// A guest id made of a file's or a figure's name: "Dance 7.bvh.xz" is dance-7.
std::string guest_name_of(std::string name);

}  // namespace dance
