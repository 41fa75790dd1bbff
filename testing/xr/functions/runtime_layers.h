// The layers of a frame: checked, recorded, and made into pictures.
//
// Units/frames: as submitted.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      the error that the application gets.
#pragma once

#include "testing/xr/state/runtime_call.h"

namespace dance::test_xr {

XrResult check_layers(XrCall& call, const Session& session, const XrFrameEndInfo& info);
void record_frame(XrCall& call, const Session& session, const XrFrameEndInfo& info);

}  // namespace dance::test_xr
