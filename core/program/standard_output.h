// Text to stdout that must arrive, such as a secret that is shown once.
//
// Threads: call from main; SIGPIPE is ignored meanwhile.
// Failure: an Error with the system's reason, also where the reader of a pipe is gone.
#pragma once

#include <string_view>

#include "core/base/result.h"

namespace dance {

// Writes the text and flushes it.
Result<void> write_to_stdout(std::string_view text);

}  // namespace dance
