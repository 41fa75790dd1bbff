// Detects the kind of a file by its first bytes: kinds that dance reads, and kinds that people take
// for them, each with the command or the step that helps.
//
// Ownership:    returns texts of its own.
// Threads:      any; content_of_file() reads on the caller's thread.
// Failure:      content that is not known is kUnknown: the caller may then go by the file's name.
//               Bytes are untrusted; at most kHead_bytes are looked at.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

enum class FileContent : std::uint8_t {
  kUnknown,
  kEmpty,
  kLcmLog,
  kBvh,
  kGlb,
  kGltf,
  kMcap,
  kTable,
  kSessionFile,
  kSound,
  kFilm,
  kPicture,
  kLcmType,
  kLogIndex,
  kZip,
  kGzip,
  kXz,  // of anything but a BVH, which is kBvh
  kZstd,
  kBzip2,
  kSevenZip,
  kRar,
  kTar,
  kFilePointer,  // of Git LFS or git-annex
  kFbx,
  kBlend,
  kC3d,
  kRosBag,
  kDatabase,
  kAcclaim,
  kCollada,
  kWebPage,
  kJson,
};

constexpr std::size_t kHead_bytes = std::size_t{64} << 10;

FileContent content_of(std::string_view head);
// kUnknown of what is no regular file or cannot be read: the reader that opens it says why.
FileContent content_of_file(const std::string& path);

// "a ZIP archive".
std::string_view content_name(FileContent content);
// Describes a file that should be `wanted`: "a ZIP archive, not an LCM log; unpack it first, and
// name the file in it".
std::string wrong_content(FileContent content, std::string_view wanted);

// Checks a file for a reader of the `readable` kinds: an Error that names the file if it evidently
// holds another kind. Unknown and empty content passes.
Result<void> check_content(const std::string& path, std::initializer_list<FileContent> readable,
                           std::string_view wanted);

}  // namespace dance
