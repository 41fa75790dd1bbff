// A night that never was, as a log: five guests with hands, some of them captured in this house and
// some on its stage, who pause and come late, and write to each other; two songs. For tests of
// replay.
//
// Units/frames: the house's clock is kWallAhead_us behind the log's.
// Ownership:    returns the bytes.
// Threads:      none inside.
// Failure:      none; the same bytes each time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/log/log_packer.h"

namespace dance {

constexpr std::int64_t kNightWallAhead_us = 1'700'000'000'000'000;

// Writes it to `path`, plain or packed.
void write_recorded_night(const std::string& path, double seconds, bool is_packed);

}  // namespace dance
