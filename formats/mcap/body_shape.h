// The bodies and the floor as Foxglove draws them: solids that are fixed to the frames of the
// transforms, so that they move without being sent again.
//
// Units/frames: metres; each entity in its bone's frame "<guest>/<bone>", the floor in "stage".
// Ownership:    appends to the caller's text.
// Threads:      none inside.
// Failure:      none.
// Source:       Foxglove schemas, SceneUpdate.
#pragma once

#include <cstdint>

#include "core/base/guest_id.h"
#include "core/pose/skeleton.h"
#include "formats/mcap/json_text.h"

namespace dance {

// colour_index: each guest has one of eight.
void append_body(JsonText& json, const GuestId& guest, const Skeleton& skeleton,
                 std::size_t colour_index, std::uint64_t time_ns);
void append_floor(JsonText& json, std::uint64_t time_ns);
// Takes away what was drawn on the same channel.
void append_no_body(JsonText& json, std::uint64_t time_ns);

}  // namespace dance
