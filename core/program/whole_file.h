// Reads whole files, and writes them atomically: to a temporary file beside it, then renamed, so
// that readers see the old one or the new one, also when the writer is stopped.
//
// Units/frames: none.
// Ownership:    nothing stays.
// Threads:      any; of two processes that write one file, one wins.
// Failure:      an Error names the file, the reason and the cure; the old file stays. If renaming
//               fails the temporary file stays, and the Error names it. Devices and pipes are
//               written directly.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

// Whether it could be written now: to be checked before work that takes minutes.
Result<void> try_whole_file(const std::string& path);

Result<void> write_whole_file(const std::string& path, std::string_view content);
Result<void> write_whole_file(const std::string& path, std::span<const std::uint8_t> content);

// Of a regular file, if it has no more than `most_bytes`.
Result<std::string> read_whole_file(const std::string& path, std::size_t most_bytes);

bool is_xz(std::string_view bytes);
struct Unpacked {
  std::string bytes;
  bool is_cut = false;  // the packed file ends early: these are the bytes up to there
};
constexpr const char* kXzIsCut = "the xz file is cut short; copy it again";

// Decompresses an xz file to at most `most_bytes`; other bytes are returned unchanged.
Result<Unpacked> unpacked_part(std::string bytes, std::size_t most_bytes);
// The same, where a part is an Error.
Result<std::string> unpacked(std::string bytes, std::size_t most_bytes);

}  // namespace dance
