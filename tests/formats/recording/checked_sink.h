// CheckedSink: what a reader of recordings hands out is valid, whatever it read: for fuzz targets.
//
// Threads: none inside.
// Failure: an assertion stops the program.
#pragma once

#include "core/base/assert.h"
#include "formats/recording/recording_sink.h"

namespace dance {

struct CheckedSink : RecordingSink {
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(skeleton));
  }
  void on_pose(const GuestId& guest, const Pose& pose, std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(pose), pose.sequence);
  }
  void on_hands(const GuestId& guest, const Hands& hands, std::int64_t) override {
    DANCE_ASSERT(guest.is_set() && is_valid(hands), hands.sequence);
  }
  void on_beat(const Beat& beat, std::int64_t) override { DANCE_ASSERT(is_valid(beat), beat.beat); }
};

}  // namespace dance
