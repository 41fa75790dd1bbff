// Whether this program may read keys from the terminal that it was started in.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      any.
// Failure:      none; false without a terminal.
#pragma once

#include <unistd.h>

namespace dance {

// In the background of a shell, reading the terminal or setting it would stop the program.
inline bool is_in_foreground() {
  return isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp();
}

}  // namespace dance
