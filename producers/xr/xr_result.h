// What the runtime of a headset answers, as lines for people.
//
// Units/frames: none.
// Ownership:    returns new texts.
// Threads:      any.
// Failure:      is what this tells.
#pragma once

#include <openxr/openxr.h>

#include <string>

#include "core/base/result.h"

namespace dance {

// "XR_ERROR_SESSION_LOST"; the number of one that this build does not know.
std::string name_of(XrResult result);

// `what` is the call, or what it was for: "the runtime refuses a session (XR_ERROR_…)".
Result<void> checked(XrResult result, const char* what);

}  // namespace dance
