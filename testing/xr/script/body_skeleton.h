// A plausible body under a head: where the joints of OpenXR's body tracking are, from the points of
// a script. What the script has (hips, chest, elbows, knees, feet, hands) counts; the rest stands.
//
// Units/frames: metres; in the stage as it was at first.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <vector>

#include "testing/xr/script/xr_scene.h"

namespace dance::test_xr {

// In the orders of XrFullBodyJointMETA (its first 70 are XrBodyJointFB's) and XrBodyJointBD.
std::vector<Pose> full_body(const XrScript& script, double time_s);
std::vector<Pose> small_body(const XrScript& script, double time_s);

}  // namespace dance::test_xr
