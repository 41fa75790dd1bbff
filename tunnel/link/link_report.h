// What a link did: as JSON for scripts, with totals and each guest of the other houses; and for
// people, what was the matter with its sealed session.
//
// Units/frames: units stand in the names of the JSON.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>

#include "tunnel/link/link.h"

namespace dance {

// {"sent", "delivered", …, "round_trip_us", "bytes_in_per_s", …,
//  "guests": [{"id", "here", "received", "lost", "late", …}],
//  "own": [{"id", "sent", "acked", "references", …}]}
std::string link_report_json(const Link& link);

// Where there was more than one handshake, or something was kept out: what, as the end of a
// sentence (", …"). Else "".
std::string seal_trouble_text(const SealClientCounters& seal);

}  // namespace dance
