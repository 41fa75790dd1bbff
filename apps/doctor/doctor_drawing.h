// Whether this machine can draw the viewer's pictures, tried for real: an OpenGL context is made,
// in a child process, as a driver may take the process that loads it down.
//
// Ownership: plain values.
// Threads:   call from main.
// Failure:   the finding says what is missing and the cure.
#pragma once

#include "apps/doctor/doctor_checks.h"

namespace dance {

Finding check_drawing();

}  // namespace dance
