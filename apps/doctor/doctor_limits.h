// Checks of what this machine lets a program use: room on its disks, and open files.
//
// Units/frames: bytes.
// Threads:      call from main.
// Failure:      a check that cannot look leaves its finding out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/doctor/doctor_checks.h"

namespace dance {

// Judges the free space where recordings go.
Finding check_disk(const std::string& folder, std::uint64_t free_bytes);
// Judges the limit of open files; `most` is to what this user may raise it.
Finding check_open_files(std::uint64_t limit, std::uint64_t most);

std::vector<Finding> examine_limits();

}  // namespace dance
