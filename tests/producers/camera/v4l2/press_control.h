// Presses a button that a video device has among its controls, found by its name: vivid's
// "Disconnect" pulls the cable.
//
// Ownership: opens the device for the call.
// Threads:   any.
// Failure:   false where there is no such device or button, or it refuses.
#pragma once

#include <string>

namespace dance {

bool press_control(const std::string& path, const std::string& name, int value);

}  // namespace dance
