// The sliders of the style panel, in two groups: transformers of a route, and zones of the body.
//
// Units/frames: `em` is the height of a line's letters, pixels.
// Ownership:    none.
// Threads:      the drawing thread, between ImGui's Begin and End.
// Failure:      none.
#pragma once

#include "core/signal/flow_setting.h"

namespace dance {

// True where a person changed something.
bool edit_transformers(FlowSetting& setting, float em);
bool edit_zones(Style& style, float usual_dynamic, float em);

}  // namespace dance
