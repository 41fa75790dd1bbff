// The text of a file that holds a recorded line, unpacked where it is packed with xz; its bytes
// tell, not its name.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_trace_file() names the file and the cure; more than 64 MB, packed or not, is
//               refused.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

constexpr std::size_t kMostTraceBytes = 64u << 20;

Result<std::string> read_trace_file(const std::string& path);

// "line 3: not a time: 'x'", with what cannot be printed left out.
tl::unexpected<Error> broken_trace_line(std::size_t line, const char* what, std::string_view text);

}  // namespace dance
