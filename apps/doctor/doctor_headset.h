// Checks whether a runtime of OpenXR is active on this machine and its library is there, without
// loading it: a vendor's code is no part of a check.
//
// Threads:      one.
// Failure:      none; a fault is a Finding.
#pragma once

#include "apps/doctor/doctor_checks.h"
#include "formats/openxr/runtime_manifest.h"

namespace dance {

Finding check_headset(const openxr::Environment& environment, bool is_built);
Finding check_headset();

}  // namespace dance
