// DanceWishes: what a person asks of the window by the dance panel.
//
// Ownership: plain value.
// Threads:   the drawing thread.
// Failure:   none.
#pragma once

#include <vector>

#include "core/base/guest_id.h"

namespace dance {

struct DanceWishes {
  bool leaves = false;         // the dance; the window ends, or goes back to where it came from
  bool draws_plainly = false;  // as --quality low
  int mute_presses = 0;        // since they were obeyed last
  int deafen_presses = 0;
  std::vector<GuestId> hidden;  // not to be drawn, in this window
};

}  // namespace dance
