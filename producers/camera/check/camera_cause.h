// Why a camera cannot be opened, as a program can tell it apart.
//
// Ownership: plain function.
// Threads:   call where the camera is not open; opens it for a moment.
// Failure:   what it does not know is kOther.
#pragma once

#include <string>

#include "formats/camera_view/camera_view.h"

namespace dance {

// Of a source as `dance capture` takes it.
CameraCause cause_of_failure(const std::string& called);

}  // namespace dance
