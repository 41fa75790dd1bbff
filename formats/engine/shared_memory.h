// The memory of formats/engine/segment.h as POSIX shared memory with a name, private to this user:
// OwnedSegment for the house that writes it, SeenSegment for who reads it.
//
// Units/frames: "stage" is /dev/shm/dance-engine-UID-stage on Linux.
// Ownership:    OwnedSegment holds the lock and removes the name in the end; a house that was
//               killed leaves its memory behind, which the next one uses again, so that readers
//               need not look elsewhere. SeenSegment owns its mapping, which is read-only.
// Threads:      one owner each.
// Failure:      a name that another living house has, memory that is not this user's, and none that
//               is left are errors with the cure. Sizes are checked before anything is mapped. A
//               program of this user that made the memory shorter would end its readers, as it
//               could by other means: no house does, and other users cannot.
#pragma once

#include <sys/types.h>

#include <memory>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "formats/engine/segment.h"

namespace dance::engine {

using MemoryName = FixedString<63>;
MemoryName memory_name(const GuestId& name);

class OwnedSegment {
 public:
  static Result<std::unique_ptr<OwnedSegment>> open(const GuestId& name);
  ~OwnedSegment();
  OwnedSegment(const OwnedSegment&) = delete;
  OwnedSegment& operator=(const OwnedSegment&) = delete;

  // What was in it before, if anything: it is the caller's to initialise.
  Segment& segment() { return *segment_; }
  const MemoryName& name() const { return name_; }

 private:
  OwnedSegment(const MemoryName& name, int fd, Segment* segment)
      : name_(name), fd_(fd), segment_(segment) {}
  MemoryName name_;
  int fd_;
  Segment* segment_;
};

class SeenSegment {
 public:
  enum class Look : std::uint8_t { kNothing, kSame, kNew, kWrongVersion, kDamaged };

  explicit SeenSegment(const GuestId& name) : name_(memory_name(name)) {}
  ~SeenSegment() { forget(); }
  SeenSegment(const SeenSegment&) = delete;
  SeenSegment& operator=(const SeenSegment&) = delete;

  // Whether the name leads to memory that can be read, and maps it where it is new. What is mapped
  // stays while there is nothing better.
  Look look();
  void forget();
  // nullptr before the first.
  const Segment* segment() const { return segment_; }

 private:
  MemoryName name_;
  const Segment* segment_ = nullptr;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace dance::engine
