// MusicTag: tags poses with musical time: the position of the music heard in this house when they
// were captured. core/bus/captures.h uses it, where poses enter.
//
// Units/frames: beats as core/base/beat.h counts them; times of the clock that the tag is made
//               with.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      a tagged pose keeps its tag; one of another clock, or captured while no music is
//               known, gets none.
#pragma once

#include <cmath>

#include "core/base/beat_clock.h"
#include "core/pose/pose.h"

namespace dance {

class MusicTag {
 public:
  explicit MusicTag(std::uint64_t clock_id) : clock_id_(clock_id) {}

  // Beats of another clock are ignored.
  void hear(const Beat& beat) {
    if (beat.clock_id == clock_id_) clock_.hear(beat);
  }
  void tag(Pose& pose) const {
    if (!std::isnan(pose.music_beats) || pose.clock_id != clock_id_) return;
    if (clock_.is_known(pose.capture_time)) pose.music_beats = clock_.position(pose.capture_time);
  }
  // The music as it is heard here.
  const BeatClock& clock() const { return clock_; }

 private:
  std::uint64_t clock_id_;
  BeatClock clock_;
};

}  // namespace dance
