// LogClock: when the poses of a log were, in the clock of the house that recorded it: from those of
// the stage, or where it is empty, from captures. The log's own times are a wall clock's; the poses
// with the least delay to the log say how far it is ahead.
//
// Units/frames: µs of the wall clock, MonoTime of the house's.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      is_known() is false without poses. A glance that lies far before all others counts
//               only when a second one confirms it, as damage does not show in glances.
#pragma once

#include <cstdint>
#include <limits>

#include "core/bus/channel.h"
#include "core/pose/pose.h"

namespace dance {

class LogClock {
 public:
  void see(Where where, const Pose& pose, std::int64_t time_us, bool is_glance) {
    if (where == Where::kStage) see(stage_, pose, pose.stamped(Hop::kStaged), time_us, is_glance);
    if (where == Where::kCapture)
      see(capture_, pose, pose.stamped(Hop::kPublished), time_us, is_glance);
  }

  bool is_known() const { return best().clock_id != 0; }
  std::uint64_t clock_id() const { return best().clock_id; }
  std::int64_t wall_ahead_us() const { return best().least_ahead_us; }
  MonoTime begin() const { return MonoTime::from_us(best().first_us - wall_ahead_us()); }
  MonoTime end() const { return MonoTime::from_us(best().last_us - wall_ahead_us()); }

 private:
  static constexpr std::int64_t kNear_us = 100'000;
  struct Times {
    std::uint64_t clock_id = 0;
    std::int64_t first_us = 0, last_us = 0;
    std::int64_t least_ahead_us = std::numeric_limits<std::int64_t>::max();
    std::int64_t suspect_us = 0;
    bool has_suspect = false;
  };
  static void see(Times& times, const Pose& pose, MonoTime stamp, std::int64_t time_us,
                  bool is_glance) {
    if (!stamp.is_set()) return;
    const std::int64_t ahead_us = time_us - stamp.since_zero_us();
    if (times.clock_id == 0) {
      times.clock_id = pose.clock_id;
      times.first_us = time_us;
    } else if (is_glance && ahead_us < times.least_ahead_us - kNear_us) {
      const bool is_confirmed = times.has_suspect && ahead_us < times.suspect_us + kNear_us &&
                                ahead_us > times.suspect_us - kNear_us;
      if (!is_confirmed) {
        times.suspect_us = ahead_us;
        times.has_suspect = true;
        times.last_us = time_us;
        return;
      }
      if (times.suspect_us < ahead_us) times.least_ahead_us = times.suspect_us;
    }
    times.last_us = time_us;
    if (ahead_us < times.least_ahead_us) times.least_ahead_us = ahead_us;
  }
  const Times& best() const { return stage_.clock_id != 0 ? stage_ : capture_; }

  Times stage_, capture_;
};

}  // namespace dance
