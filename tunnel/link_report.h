// What a link did, as JSON for scripts: totals, and each guest of the other houses.
//
// Units/frames: units stand in the names of the JSON.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>

#include "tunnel/link.h"

namespace dance {

// {"sent", "delivered", …, "round_trip_us", "bytes_in_per_s", …,
//  "guests": [{"id", "here", "received", "lost", "late", …}],
//  "own": [{"id", "sent", "acked", "references", …}]}
std::string link_report_json(const Link& link);

}  // namespace dance
