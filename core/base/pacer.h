// Absolute deadlines for periodic work: deadline k is start + k·period, so lateness does not
// accumulate. After a long stall missed deadlines are skipped and counted instead of being caught
// up with in a burst.
//
// Units/frames: MonoTime of the caller's clock, which the caller reads.
// Threads:      none inside; one owner.
// Failure:      none; skipped() counts deadlines that were missed by more than a period.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/assert.h"
#include "core/base/time.h"

namespace dance {

class Pacer {
 public:
  // period_s as a double keeps rates like 60 Hz exact over hours (16.666… ms is not a whole number
  // of ns).
  Pacer(MonoTime start, double hz) : start_(start), period_s_(1.0 / hz) {
    DANCE_ASSERT(hz > 0.0 && hz <= 10'000.0, hz);
  }

  MonoTime deadline() const {
    return start_ + Duration::seconds(static_cast<double>(index_) * period_s_);
  }
  Duration period() const { return Duration::seconds(period_s_); }
  bool is_due(MonoTime now) const { return now >= deadline(); }

  // Begins with the first deadline that is not before `now`: for work that started in the past.
  void begin_at(MonoTime now) {
    if (now > start_)
      index_ = static_cast<std::int64_t>(std::ceil((now - start_).as_seconds() / period_s_));
  }

  // Call when the work of the current deadline is done. Returns how late `now` was.
  Duration advance(MonoTime now) {
    const Duration late = now - deadline();
    ++index_;
    const auto behind = static_cast<std::int64_t>((now - start_).as_seconds() / period_s_);
    if (behind > index_) {
      skipped_ += static_cast<std::uint64_t>(behind - index_);
      index_ = behind;
    }
    return late;
  }

  std::uint64_t skipped() const { return skipped_; }

 private:
  MonoTime start_;
  double period_s_;
  std::int64_t index_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace dance
