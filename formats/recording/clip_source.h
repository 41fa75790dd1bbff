// Tells clips as a recording: their frames at their steady times, all clips side by side.
//
// Units/frames: the first frame is captured at start_us on a clock of the file's own (clock 1), and
//               recorded at that time.
// Ownership:    refers to the clips for the length of the call.
// Threads:      none inside.
// Failure:      none; clips that end earlier are silent from then on.
#pragma once

#include <span>

#include "core/pose/clip.h"
#include "formats/recording/recording_sink.h"

namespace dance {

struct GuestClip {
  GuestId guest;
  const MotionClip* clip = nullptr;
};

void play_clips_into(std::span<const GuestClip> clips, std::int64_t start_us, RecordingSink& sink);

}  // namespace dance
