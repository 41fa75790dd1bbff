#include "core/pose/history.h"

#include "core/base/assert.h"
#include "core/pose/interpolate.h"

namespace dance {

PoseHistory::PoseHistory(std::size_t capacity) : ring_(capacity), is_reached_straight_(capacity) {
  DANCE_ASSERT(capacity >= 2, capacity);
}

bool PoseHistory::push(const Pose& pose) {
  if (size_ > 0 && pose.capture_time <= newest().capture_time) return false;
  ring_[next_] = pose;
  is_reached_straight_[next_] = false;
  next_ = (next_ + 1) % ring_.size();
  if (size_ < ring_.size()) ++size_;
  return true;
}

const Pose& PoseHistory::newest(std::size_t back) const {
  DANCE_ASSERT(back < size_, back, size_);
  return ring_[slot(back)];
}

std::size_t PoseHistory::slot(std::size_t back) const {
  return (next_ + 2 * ring_.size() - 1 - back) % ring_.size();
}

std::optional<PoseHistory::Answer> PoseHistory::at_for_good(MonoTime t) {
  if (size_ >= 2 && t > newest(1).capture_time && t < newest().capture_time)
    is_reached_straight_[slot(0)] = true;
  return at(t);
}

std::optional<PoseHistory::Answer> PoseHistory::at(MonoTime t) const {
  if (size_ == 0) return std::nullopt;
  if (t > newest().capture_time) return Answer{newest(), How::kHeldLast};
  if (t < oldest().capture_time) return Answer{oldest(), How::kHeldFirst};
  // Binary search for the smallest `back` whose pose is not after t.
  std::size_t low = 0, high = size_ - 1;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (newest(middle).capture_time <= t)
      high = middle;
    else
      low = middle + 1;
  }
  const Pose& before = newest(low);
  if (before.capture_time == t) return Answer{before, How::kExact};
  const Pose& after = newest(low - 1);
  const double fraction = (t - before.capture_time).as_seconds() /
                          (after.capture_time - before.capture_time).as_seconds();
  const auto is_close = [](const Pose& earlier, const Pose& later) {
    return later.capture_time - earlier.capture_time <= kCloseTogether;
  };
  const Pose *first = nullptr, *last = nullptr;
  if (is_close(before, after)) {
    if (low + 1 < size_ && is_close(newest(low + 1), before)) first = &newest(low + 1);
    if (low >= 2 && !is_reached_straight_[slot(low - 1)] && is_close(after, newest(low - 2)))
      last = &newest(low - 2);
  }
  return Answer{interpolate_smoothly(first, before, after, last, static_cast<float>(fraction)),
                How::kInterpolated};
}

}  // namespace dance
