// Checks of this machine's limits for programs: free disk space and open files.
//
// Units/frames: bytes.
// Threads:      call from main.
// Failure:      a check that cannot read the system's state returns no finding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/doctor/doctor_checks.h"

namespace dance {

// Judges the free space where recordings go.
Finding check_disk(const std::string& folder, std::uint64_t free_bytes);
// Judges the limit of open files; `most` is the highest that this user may set.
Finding check_open_files(std::uint64_t limit, std::uint64_t most);

std::vector<Finding> examine_limits();

}  // namespace dance
