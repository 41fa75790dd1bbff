// Past poses of one dancer, by time.
//
// Units/frames: times are capture times of one clock (the caller sees to it); poses are in W.
// Ownership:    keeps copies in a ring; never allocates after construction.
// Threads:      none inside; one thread owns it.
// Failure:      at() on an empty history returns nullopt; push() of a pose that is not newer is
//               refused (false).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose/pose.h"

namespace dance {

class PoseHistory {
 public:
  enum class How { kExact, kInterpolated, kHeldFirst, kHeldLast };
  struct Answer {
    Pose pose;
    How how;
  };

  static constexpr Duration kCloseTogether = Duration::ms(100);

  explicit PoseHistory(std::size_t capacity);

  bool push(const Pose& pose);
  void clear() { size_ = 0; }

  // The pose at time t: a pushed one, an interpolation, or the nearest end. Interpolation is cubic
  // between poses no more than kCloseTogether apart, linear across longer gaps.
  std::optional<Answer> at(MonoTime t) const;
  // The same, and final: no later pose changes what at() and this return for this moment. Between
  // the newest two poses, where the cubic needs the next one, the end is taken as straight.
  std::optional<Answer> at_for_good(MonoTime t);

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Pose& newest(std::size_t back = 0) const;  // back < size()
  const Pose& oldest() const { return newest(size_ - 1); }

 private:
  std::size_t slot(std::size_t back) const;

  std::vector<Pose> ring_;
  std::vector<bool> is_reached_straight_;  // the segment to the pose in that slot is final
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace dance
