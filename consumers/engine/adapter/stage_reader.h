// StageReader: what a reader's handle of dance_adapter.h is: finds the house's memory, follows it
// when it goes and comes back, keeps each dancer's last poses to answer for any time, and gives all
// out in the engine's axes.
//
// Units/frames: those of dance_adapter.h; times in ns of CLOCK_MONOTONIC.
// Ownership:    owns the mapping and 64 pose histories; never allocates after construction.
// Threads:      one owner at a time.
// Failure:      a dance_status; nothing waits. Arguments must have been checked.
#pragma once

#include <array>
#include <vector>

#include "consumers/engine/adapter/axes.h"
#include "consumers/engine/dance_adapter.h"
#include "core/base/beat_clock.h"
#include "core/base/time.h"
#include "core/pose/history.h"
#include "formats/engine/segment_reader.h"
#include "formats/engine/shared_memory.h"

namespace dance::engine {

class StageReader {
 public:
  // A house that is not there is looked for at most this often.
  static constexpr std::int64_t kLookAgain_ns = 100'000'000;

  StageReader(const GuestId& name, const Axes& axes);

  dance_status refresh(std::int64_t now_ns);
  // What stands in the slot; kNoGuest and kDamaged are skipped by those who list.
  Outcome guest(std::size_t slot, dance_guest& out);
  dance_status newest(std::size_t slot, dance_pose& out);
  dance_status at(std::size_t slot, std::int64_t time_ns, dance_pose& out);
  dance_status skeleton(std::size_t slot, dance_skeleton& out);
  dance_status hands(std::size_t slot, dance_hands& out);
  dance_status beat(std::int64_t time_ns, dance_beat& out);
  // A call was answered with DANCE_BUSY.
  void count_busy() { ++busy_; }
  dance_counters counters() const;

 private:
  // One dancer's last poses.
  struct Dancer {
    PoseHistory poses{kPoseRing};
    std::uint32_t generation = 0;
    std::uint64_t number = 0;  // of the newest
    std::int64_t lag_ns = 0;
    int overtaken = 0;       // poses in turn that were captured before the newest
    std::uint64_t seen = 0;  // the newest number in the memory when it was read last
  };

  dance_status look();
  void forget_dancers();
  SegmentReader reader() { return SegmentReader(*seen_.segment(), counters_); }
  bool is_ahead(std::size_t slot, std::uint32_t generation, std::int64_t time_ns, dance_pose& out);
  Outcome catch_up(std::size_t slot, std::uint32_t generation);
  void remember(Dancer& dancer, const StoredPose& stored);
  void prefetch(std::size_t slot) const;
  void give(const StoredPose& stored, dance_pose& out) const;
  void give(const Pose& pose, dance_pose& out) const;

  SeenSegment seen_;
  const Axes& axes_;
  std::int64_t looked_ns_ = -kLookAgain_ns;
  dance_status status_ = DANCE_NO_HOUSE;
  std::uint64_t epoch_ = 0;
  std::uint64_t attached_ = 0;
  std::uint64_t busy_ = 0;
  ReadCounters counters_;
  std::vector<Dancer> dancers_;
  BeatClock beat_;
  std::uint64_t beat_number_ = 0;
};

}  // namespace dance::engine
