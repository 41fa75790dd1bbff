// Reads a file whole, and writes one whole or not at all: beside its place first, so that a reader
// has the old one or the new one, and so has the next run when the writer is stopped.
//
// Units/frames: none.
// Ownership:    nothing stays.
// Threads:      any; of two processes that write one file, one's is there.
// Failure:      an Error names the file, the reason and the cure; what was there before stays.
//               Where it could be written but not take its place, it stays beside it, and the Error
//               says where. A device or a pipe has no place beside it: what it got, it has.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

// Whether it could be written now: asked before work that takes minutes.
Result<void> try_whole_file(const std::string& path);

Result<void> write_whole_file(const std::string& path, std::string_view content);
Result<void> write_whole_file(const std::string& path, std::span<const std::uint8_t> content);

// Of a regular file, if it has no more than `most_bytes`.
Result<std::string> read_whole_file(const std::string& path, std::size_t most_bytes);

bool is_xz(std::string_view bytes);
// What an xz file holds, if that is no more than `most_bytes`; other bytes as they are.
Result<std::string> unpacked(std::string bytes, std::size_t most_bytes);

}  // namespace dance
