// StillWindow: the mean of all points over the time for which a dancer has stood still.
//
// Units/frames: as tracker_frame.h.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. A point that moves, or a head or hand that comes or goes, restarts it.
#pragma once

#include "producers/trackers/tracker_mounts.h"

namespace dance {

class StillWindow {
 public:
  static constexpr Duration kLength = Duration::ms(800);

  // Returns whether the dancer has just stood still for kLength; then a new window begins.
  bool add(const TrackerFrame& frame);
  void clear() { count_ = 0; }

  // Of the window that was full last.
  const BonePlaces& means() const { return means_; }
  // Of the one that is being filled, 0 … 1.
  float progress() const;

 private:
  bool is_still(const TrackerFrame& frame) const;

  TrackerFrame first_;
  std::array<Eigen::Vector3f, kTrackedPointCount> position_sums_;
  std::array<Eigen::Vector4f, kTrackedPointCount> rotation_sums_;
  std::array<int, kTrackedPointCount> seen_{};
  BonePlaces means_;
  MonoTime newest_;
  int count_ = 0;
};

}  // namespace dance
