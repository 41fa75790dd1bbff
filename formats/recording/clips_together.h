// The guests of a recording as clips that begin at one moment and have frames at the same times, so
// that a couple stays together in files that hold several dancers.
//
// Units/frames: frames lie 1/hz apart. Capture times of one clock are compared as they are; those
//               of different clocks through the times of the recording, by the fastest message.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      counted: poses and hands that are not newer, frames beyond the bound. A guest who
//               is silent for longer than kLongestGap, has not come yet or has left, stands still.
#pragma once

#include <vector>

#include "core/pose/clip.h"
#include "formats/recording/recording.h"

namespace dance {

struct ClipsTogether {
  struct Of {
    GuestId guest;
    MotionClip clip;
  };
  struct Counters {
    std::uint64_t not_newer = 0;
    std::uint64_t silences = 0;
    std::uint64_t beyond_bound = 0;  // frames of all guests
  };
  std::vector<Of> clips;  // of the guests with poses, in the order in which they came
  Counters counters;
};

// At most so many frames of all guests together: about 800 MB with hands.
constexpr std::size_t kMostFramesTogether = 4 * 60 * 3600;

ClipsTogether clips_together(const Recording& recording, double hz,
                             std::size_t most_frames = kMostFramesTogether);

}  // namespace dance
