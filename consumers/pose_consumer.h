// PoseConsumer: the interface of what is made of the dancers of a house: lines of text, a file,
// another program's protocol, the memory that an engine reads. A new consumer is one class that
// implements this, and one row in the table of consumer_table.cpp.
//
// Units/frames: poses as in core/pose/pose.h; now is this process's clock.
// Ownership:    keeps what it needs of a pose; memory is bounded however long it listens.
// Threads:      none inside; one owner.
// Failure:      flush() and finish() tell what could not be written; calling finish() is part of
//               using a consumer.
#pragma once

#include <string>

#include "core/base/beat.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/pose/face.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class PoseConsumer {
 public:
  virtual ~PoseConsumer() = default;
  virtual void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) = 0;
  virtual void on_skeleton(const GuestId&, const Skeleton&, MonoTime) {}
  virtual void on_hands(const GuestId&, const Hands&, MonoTime) {}
  virtual void on_face(const GuestId&, const Face&, MonoTime) {}
  // Of the music that is heard in this house.
  virtual void on_beat(const Beat&, MonoTime) {}
  // For what is repeated, and to notice guests that fell silent.
  virtual void on_second(MonoTime) {}
  // Writes what is buffered, so that readers of a pipe have it. What goes to another program as
  // datagrams or through memory does not wait for this.
  virtual Result<void> flush() { return {}; }
  // Writes what is still held back.
  virtual Result<void> finish() = 0;
  // Poses and frames that were received and are not in its file: too many, or of other guests.
  virtual std::uint64_t left_out() const { return 0; }
  // One line: what was written, and what was left out and why.
  virtual std::string summary() const = 0;
};

}  // namespace dance
