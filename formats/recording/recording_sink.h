// RecordingSink: what is in a recorded night, told in the order of the recording: the interface
// between the readers of files and the writers of others, so that a night of any length passes
// through in little memory.
//
// Units/frames: time_us is when it was recorded: microseconds of the recorder's wall clock, or of
//               a file's own zero where it has no date. Poses, hands and beats keep their own times
//               and clocks.
// Ownership:    arguments are the caller's.
// Threads:      none inside; one owner.
// Failure:      none here; a sink that writes tells in its own finish() what could not be written.
#pragma once

#include <cstdint>

#include "core/base/beat.h"
#include "core/base/guest_id.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class RecordingSink {
 public:
  virtual ~RecordingSink() = default;
  // Before the first pose of a guest where it is known, and again when it changes.
  virtual void on_skeleton(const GuestId& guest, const Skeleton& skeleton,
                           std::int64_t time_us) = 0;
  virtual void on_pose(const GuestId& guest, const Pose& pose, std::int64_t time_us) = 0;
  virtual void on_hands(const GuestId& guest, const Hands& hands, std::int64_t time_us) = 0;
  virtual void on_beat(const Beat& beat, std::int64_t time_us) = 0;
};

}  // namespace dance
