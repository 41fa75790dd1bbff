// The summary of a demo, as a table for people and as JSON for scripts.
//
// Units/frames: ages in ms from capture.
// Threads:      none inside.
// Failure:      none; what was not reported is left out.
#pragma once

#include <string>

#include "apps/demo/demo_run.h"

namespace dance {

std::string summary_json(const DemoResult& result);
std::string summary_table(const DemoResult& result);

}  // namespace dance
