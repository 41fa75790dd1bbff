// The process's clock and its name. The only place that reads CLOCK_MONOTONIC.
//
// Units/frames: MonoTime since boot (suspension not counted).
// Threads:      any.
// Failure:      none; without the kernel's boot id the clock id is random, so that clocks do not
//               compare equal by chance.
#pragma once

#include <cstdint>

#include "core/base/time.h"

namespace dance {

MonoTime mono_now();

// Names this machine's clock of this boot: processes that share the clock get the same id; never 0.
std::uint64_t this_clock_id();

}  // namespace dance
