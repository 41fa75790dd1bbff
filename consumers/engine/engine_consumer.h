// EngineConsumer: puts the dancers of a house into shared memory, where engines and other programs
// of this machine read them through libdance_adapter.so: poses, hands, proportions, the beat.
//
// Units/frames: capture times in this house's clock: those of another clock (a recording that is
//               played) are mapped so that a pose of the least delay was captured when it was
//               shown.
// Ownership:    owns the memory, which is gone when it ends; 64 dancers at most. Never allocates
//               after construction.
// Threads:      none inside; one owner. Readers look at the memory at any time, and nothing waits
//               for them.
// Failure:      open() names a house that has the name already. Dancers beyond 64 and what does not
//               fit are counted.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "consumers/engine/stage_lag.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "formats/engine/segment_writer.h"
#include "formats/engine/shared_memory.h"

namespace dance {

class EngineConsumer final : public PoseConsumer {
 public:
  static constexpr const char* kUsualName = "stage";
  // A dancer without a pose for so long has left.
  static constexpr Duration kSilence = Duration::s(5);
  // A capture time that goes back further is not that of a pose which was overtaken.
  static constexpr Duration kAnotherDance = Duration::ms(500);

  struct Counters {
    std::uint64_t poses = 0;
    std::uint64_t guests = 0;
    std::uint64_t too_many = 0;  // poses of dancers beyond the slots
    std::uint64_t invalid = 0;   // out of the format's bounds
  };

  static Result<std::unique_ptr<EngineConsumer>> open(const std::string& name, double hz,
                                                      std::uint64_t own_clock_id, MonoTime now);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  void on_beat(const Beat& beat, MonoTime now) override;
  void on_second(MonoTime now) override;
  Result<void> finish() override;
  std::string summary() const override;

  const Counters& counters() const { return counters_; }

 private:
  struct Dancer {
    GuestId guest;  // not set: the slot is free
    MonoTime heard;
    bool is_shown = false;
    MonoTime captured;  // the last
    StageLag lag;
    std::int64_t lag_ns = 0;
    std::uint32_t skeleton_version = 0;
    Skeleton skeleton;
  };

  EngineConsumer(std::unique_ptr<engine::OwnedSegment> memory, double hz,
                 std::uint64_t own_clock_id, MonoTime now);
  // The slot of a guest; kGuestSlots: none is free.
  std::size_t slot_of(const GuestId& guest, MonoTime now);

  std::unique_ptr<engine::OwnedSegment> memory_;
  std::string name_;
  engine::SegmentWriter writer_;
  RateLimit limit_;
  std::uint64_t own_clock_id_;
  std::array<Dancer, engine::kGuestSlots> dancers_;
  Counters counters_;
};

}  // namespace dance
