// Route: which poses reach the stage, and through which transformers.
//
// Units/frames: rates in Hz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the words of `through` are checked where a flow is made of them.
#pragma once

#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/bus/channel.h"

namespace dance {

// One end of a route: POSE/<where>/<guest> or POSE/<where>/*.
struct RouteEnd {
  Where where = Where::kCapture;
  GuestId guest;  // not set: all of them
};

struct Route {
  RouteEnd from;
  RouteEnd to;                       // guest not set: the one that came in
  std::vector<std::string> through;  // specifications of transformers
  double rate_hz = 0.0;              // 0: as poses arrive (only without transformers)
};

}  // namespace dance
