// DanceWishes: what a person asks of the window by the dance panel.
//
// Ownership: plain value.
// Threads:   the drawing thread.
// Failure:   none.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/guest_id.h"

namespace dance {

// Closing a window that hosts the room ends it for all, so the panel asks first.
enum class Closing : std::uint8_t { kNo, kAsked, kYes };

struct DanceWishes {
  bool leaves = false;         // the dance; the window ends, or goes back to where it came from
  bool draws_plainly = false;  // as --quality low
  bool knows_slow_drawing = false;  // the note on it was shown, and is not shown again
  bool takes_picture = false;       // of the stage, into a file
  int mute_presses = 0;             // not handled yet
  int deafen_presses = 0;
  Closing closing = Closing::kNo;
  std::vector<GuestId> hidden;  // not to be drawn, in this window
};

}  // namespace dance
