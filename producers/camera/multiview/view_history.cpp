#include "producers/camera/multiview/view_history.h"

#include <algorithm>

namespace dance {

bool ViewHistory::add(const ViewPoints& points) {
  if (count_ > 0 && points.time <= newest()->time) return false;
  if (count_ == kCapacity) {
    begin_ = (begin_ + 1) % kCapacity;
    --count_;
  }
  (*ring_)[(begin_ + count_++) % kCapacity] = points;
  return true;
}

bool ViewHistory::at(MonoTime time, ViewMoment& out) const {
  if (count_ < 2 || time < entry(0).time || time > newest()->time) return false;
  std::size_t low = 0, high = count_ - 1;  // entry(low) <= time <= entry(high)
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (entry(middle).time <= time ? low : high) = middle;
  }
  const ViewPoints &before = entry(low), &after = entry(high);
  if (after.time - before.time > kGap) return false;
  const double gap_s = (after.time - before.time).as_seconds();
  const double share = (time - before.time).as_seconds() / gap_s;
  for (std::size_t i = 0; i < kViewPointCount; ++i) {
    const Eigen::Vector2d from = before.ray[i].cast<double>(), to = after.ray[i].cast<double>();
    out.ray[i] = from + share * (to - from);
    out.rate[i] = (to - from) / gap_s;
    out.weight[i] = static_cast<double>(std::min(before.weight[i], after.weight[i]));
  }
  out.nearest = share < 0.5 ? &before : &after;
  return true;
}

}  // namespace dance
