// The lines of a script that begin with `at`.
//
// Units/frames: seconds of the script's clock; places in metres.
// Ownership:    none.
// Threads:      none inside.
// Failure:      errors name the word and the cure.
#pragma once

#include "testing/xr/script/xr_script.h"
#include "testing/xr/script/xr_words.h"

namespace dance::test_xr {

Result<void> add_event(const Words& words, XrScript& script);

}  // namespace dance::test_xr
