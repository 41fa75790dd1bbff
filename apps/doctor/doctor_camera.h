// Checks of cameras and of the pose network.
//
// Ownership: plain values.
// Threads:   one; looking opens each camera for a moment.
// Failure:   none; a fault is a Finding.
#pragma once

#include "apps/doctor/doctor_checks.h"

namespace dance {

Finding check_camera();
Finding check_pose_network();

}  // namespace dance
