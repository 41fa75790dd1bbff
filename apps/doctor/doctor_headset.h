// Checks whether a runtime of OpenXR is active on this machine, without loading it: a vendor's code
// is no part of a check.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      one.
// Failure:      none; a fault is a Finding.
// Source:       OpenXR loader design, "Linux runtime discovery".
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/doctor/doctor_checks.h"

namespace dance {

// A variable of the environment; "" where it is not set.
using Environment = std::function<std::string(const char* name)>;

// Where the loader looks, in its order.
std::vector<std::string> openxr_manifests(const Environment& environment);
Finding check_headset(const Environment& environment, bool is_built);
Finding check_headset();

}  // namespace dance
