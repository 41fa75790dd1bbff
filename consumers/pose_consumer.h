// PoseConsumer: the interface of what is made of poses: lines of text, a table, a BVH file. A new
// consumer is one class that implements this, and one row in the table of consumer_table.cpp.
//
// Units/frames: poses as in core/pose/pose.h; now is this process's clock.
// Ownership:    keeps what it needs of a pose; memory is bounded however long it listens.
// Threads:      none inside; one owner.
// Failure:      finish() tells what could not be written; calling it is part of using a consumer.
#pragma once

#include <string>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class PoseConsumer {
 public:
  virtual ~PoseConsumer() = default;
  virtual void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) = 0;
  virtual void on_skeleton(const GuestId&, const Skeleton&, MonoTime) {}
  // Writes what is still held back.
  virtual Result<void> finish() = 0;
  // One line: what was written, and what was left out and why.
  virtual std::string summary() const = 0;
};

}  // namespace dance
