// ViewHistory: the last seconds of what one camera saw, asked for by time: between two pictures
// points are interpolated.
//
// Units/frames: the camera's own stamps; rays and rays a second.
// Ownership:    a ring of kCapacity entries inside (about 500 KB); never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      at() is false before the oldest, after the newest and in a gap longer than kGap; an
//               entry that is not newer than the last is refused.
#pragma once

#include <array>
#include <memory>

#include "producers/camera/multiview/view_points.h"

namespace dance {

struct ViewMoment {
  std::array<Eigen::Vector2d, kViewPointCount> ray;
  std::array<Eigen::Vector2d, kViewPointCount> rate;  // of the rays, a second
  std::array<double, kViewPointCount> weight;
  const ViewPoints* nearest = nullptr;
};

class ViewHistory {
 public:
  static constexpr std::size_t kCapacity = 1024;  // 34 s at 30 Hz
  static constexpr Duration kGap = Duration::ms(120);

  ViewHistory() : ring_(std::make_unique<std::array<ViewPoints, kCapacity>>()) {}
  bool add(const ViewPoints& points);
  bool at(MonoTime time, ViewMoment& out) const;
  const ViewPoints* newest() const { return count_ > 0 ? &entry(count_ - 1) : nullptr; }

 private:
  // 0 is the oldest.
  const ViewPoints& entry(std::size_t i) const { return (*ring_)[(begin_ + i) % kCapacity]; }

  std::unique_ptr<std::array<ViewPoints, kCapacity>> ring_;
  std::size_t begin_ = 0;
  std::size_t count_ = 0;
};

}  // namespace dance
