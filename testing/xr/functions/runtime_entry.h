// The door of the OpenXR test runtime: xrGetInstanceProcAddr, and what the loader asks first.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      any.
// Failure:      as OpenXR says.
#pragma once

#include <openxr/openxr.h>

namespace dance::test_xr {

XrResult XRAPI_CALL get_function(XrInstance instance, const char* name, PFN_xrVoidFunction* into);

}  // namespace dance::test_xr
