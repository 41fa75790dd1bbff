// SegmentWriter: fills the memory of formats/engine/segment.h: slots for dancers, their poses,
// hands and proportions, the beat.
//
// Units/frames: as stored: see segment.h.
// Ownership:    refers to the memory, which must outlive it; what it needs to know it keeps itself
//               and never reads back, as memory can be damaged.
// Threads:      one owner; readers look at the memory meanwhile.
// Failure:      reserve() returns nullopt when all slots are taken. Values must be valid.
#pragma once

#include <array>
#include <optional>

#include "core/base/time.h"
#include "formats/engine/segment.h"

namespace dance::engine {

class SegmentWriter {
 public:
  // Empties the memory, whatever is in it, and opens it to readers.
  SegmentWriter(Segment& segment, MonoTime now);

  // A slot for a dancer, whom readers see from show() on. The slot that is free for longest, so
  // that who has kept a number too long rather meets nobody than somebody else.
  std::optional<std::size_t> reserve(const GuestId& guest);
  void show(std::size_t slot);
  void release(std::size_t slot);

  void write(std::size_t slot, const StoredPose& pose);
  void write(std::size_t slot, const StoredHands& hands);
  void write(std::size_t slot, const StoredSkeleton& skeleton);
  void write(const StoredBeat& beat);
  void update_heartbeat(MonoTime now);
  // Readers see that it ended.
  void close();

 private:
  struct Slot {
    std::uint32_t generation = 0;
    bool is_taken = false;
    std::uint64_t freed = 0;  // in order of leaving
    // The next numbers: greater than any before, in earlier runs too, as they begin with the time
    // and nobody writes one a nanosecond.
    std::uint64_t poses = 0;
    std::uint64_t hands = 0;
    std::uint64_t skeletons = 0;
  };

  Segment& segment_;
  std::array<Slot, kGuestSlots> slots_{};
  std::uint64_t freed_ = 0;
  std::uint64_t beats_;
};

}  // namespace dance::engine
