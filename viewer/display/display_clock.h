// DisplayClock: when the display begins to show the next picture, from the moments at which swap
// calls that had to wait came back. Such a call returns at the display's turn or a little later,
// never earlier; the estimate goes by the early ones.
//
// Units/frames: MonoTime of this process.
// Ownership:    plain value; allocates nothing.
// Threads:      none inside; the drawing thread owns it.
// Failure:      is_locked() is false until enough moments lie on one beat, and when they no longer
//               do.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class DisplayClock {
 public:
  // What the monitor says of itself; used where every second turn or less was hit.
  explicit DisplayClock(Duration nominal) : nominal_(nominal), period_(nominal) {}

  void add(MonoTime returned);
  void clear();

  bool is_locked() const { return is_locked_; }
  Duration period() const { return period_; }
  // The first turn of the display after t. Only when locked.
  MonoTime next_after(MonoTime t) const;
  // How far the moments lie from the turns, 20th to 80th percentile.
  Duration spread() const { return spread_; }

 private:
  static constexpr std::size_t kMoments = 64;
  static constexpr std::size_t kFewest = 12;
  void estimate();
  Duration rough_period() const;
  std::size_t count() const { return added_ < kMoments ? added_ : kMoments; }
  MonoTime at(std::size_t back) const { return moments_[(added_ - 1 - back) % kMoments]; }

  Duration nominal_;
  Duration period_;
  MonoTime phase_;
  Duration spread_;
  bool is_locked_ = false;
  std::array<MonoTime, kMoments> moments_{};
  std::size_t added_ = 0;
};

}  // namespace dance
