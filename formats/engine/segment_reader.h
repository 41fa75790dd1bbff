// SegmentReader: takes out of the memory of formats/engine/segment.h what is valid.
//
// Units/frames: as stored: see segment.h.
// Ownership:    refers to the memory, which must outlive it.
// Threads:      one owner; the writer writes meanwhile. Nothing waits, and every loop is bounded.
// Failure:      whatever is in the memory, a call ends with an Outcome; what is not valid is
//               counted and not given out.
#pragma once

#include <array>
#include <cstdint>

#include "formats/engine/segment.h"

namespace dance::engine {

enum class Outcome : std::uint8_t {
  kFine,
  kNoGuest,  // no dancer of that generation in the slot
  kNoData,   // none of this has come
  kBusy,     // overtaken by the writer in every try
  kDamaged,  // what is there is not valid
};

enum class SegmentCheck : std::uint8_t {
  kFine,
  kNoWriter,  // being made, closed, or the writer is gone
  kWrongVersion,
  kDamaged,
};

struct GuestEntry {
  std::uint32_t generation = 0;
  GuestId id;
  std::int64_t newest_staged_ns = 0;
  bool has_skeleton = false;
  bool has_hands = false;
};

struct ReadCounters {
  std::uint64_t reads = 0;
  std::uint64_t retries = 0;
  std::uint64_t busy = 0;
  std::uint64_t damaged = 0;
};

class SegmentReader {
 public:
  static constexpr int kTries = 8;

  explicit SegmentReader(const Segment& segment, ReadCounters& counters)
      : segment_(segment), counters_(counters) {}

  // Whether there is a living writer.
  SegmentCheck check(std::int64_t now_ns) const;
  std::uint64_t epoch() const { return segment_.header.epoch.load(std::memory_order_acquire); }

  // The generation of the dancer in that slot, 0: none.
  std::uint32_t generation(std::size_t slot) const;
  Outcome guest(std::size_t slot, GuestEntry& entry);
  // The newest, and its number, which is greater than those of earlier ones.
  Outcome newest(std::size_t slot, std::uint32_t generation, StoredPose& pose,
                 std::uint64_t& number);
  Outcome newest(std::size_t slot, std::uint32_t generation, StoredSkeleton& skeleton,
                 std::uint64_t& number);
  Outcome newest(std::size_t slot, std::uint32_t generation, StoredHands& hands,
                 std::uint64_t& number);
  Outcome newest(StoredBeat& beat, std::uint64_t& number);

  // The numbers of the poses that are there after `known`: the newest kMostPoses at most.
  struct Numbers {
    std::uint64_t first = 0;
    std::uint64_t count = 0;
  };
  Numbers poses_after(std::size_t slot, std::uint64_t known) const;
  // One of them. kBusy where it was overwritten meanwhile.
  Outcome pose(std::size_t slot, std::uint32_t generation, std::uint64_t number, StoredPose& pose);

 private:
  template <class Ring, class Value>
  Outcome newest_of(const Ring& ring, Value& value, std::uint64_t& number);
  template <class Ring, class Value>
  Outcome newest_of(const Ring& ring, std::size_t slot, std::uint32_t generation, Value& value,
                    std::uint64_t& number);
  Outcome damaged();

  const Segment& segment_;
  ReadCounters& counters_;
};

}  // namespace dance::engine
