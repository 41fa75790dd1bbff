// ArrivalMeter: statistics of one guest's poses at a display: rate, age, gaps in the sequence. Used
// where the house's manager does not publish them.
//
// Units/frames: MonoTime of this process; ages only of poses that were stamped by this clock.
// Ownership:    plain value, no allocation.
// Threads:      none inside; one owner.
// Failure:      none: a sequence that jumps far or backwards is a restarted sender.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/time.h"
#include "viewer/scene/scene.h"

namespace dance {

class ArrivalMeter {
 public:
  void on_pose(std::uint32_t sequence, MonoTime heard, std::optional<Duration> age);
  // The rate of the last whole second, the mean age in it, and losses since the guest came.
  GuestFigures figures() const { return figures_; }

  // As BeatClock::carry().
  template <class Archive>
  void carry(Archive& archive) {
    archive(window_start_), archive(in_window_), archive(aged_in_window_), archive(age_sum_);
    archive(has_sequence_), archive(newest_sequence_), archive(received_), archive(lost_);
    archive(figures_.arrival_hz), archive(figures_.age_ms), archive(figures_.loss_percent);
  }

 private:
  void end_window(MonoTime now);

  MonoTime window_start_;
  int in_window_ = 0;
  int aged_in_window_ = 0;
  Duration age_sum_;
  bool has_sequence_ = false;
  std::uint32_t newest_sequence_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t lost_ = 0;
  GuestFigures figures_;
};

}  // namespace dance
