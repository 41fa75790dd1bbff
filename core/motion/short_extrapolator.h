// ShortExtrapolator: a pose some milliseconds after the newest one: each joint turns on at its
// speed and hips move on at theirs, the speed fading out, for at most kFurthest. For the last step
// to the display, where a pose is one or two frames old; predictions over longer times are
// transformers/predict. Costs some 10 us, most of it kinematics for the floor.
//
// Units/frames: as core/pose/pose.h; moments of any one clock.
// Ownership:    plain value with a few past poses; allocates nothing.
// Threads:      none inside; one owner.
// Failure:      none: without two poses that are near in time, or after a jump, the newest pose is
//               returned as it is.
#pragma once

#include <array>

#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class ShortExtrapolator {
 public:
  static constexpr Duration kFurthest = Duration::ms(50);
  // The speed that a joint has left: e^(-t / kFading).
  static constexpr Duration kFading = Duration::ms(80);
  // Speeds are taken over at least so long: over less, noise of the sensor is extrapolated.
  static constexpr Duration kSpeedOver = Duration::ms(24);
  static constexpr Duration kLongestGap = Duration::ms(120);

  // Poses in order of their moments; one that is not newer is left out, one that is much older
  // begins anew.
  void observe(const Pose& pose, MonoTime moment);
  void clear() { count_ = 0; }

  // The pose at that moment. Its lowest point is not below the floor (y = 0), nor lower than it was
  // where the newest pose already is.
  Pose at(MonoTime moment, const Skeleton& skeleton) const;

 private:
  static constexpr std::size_t kKept = 8;
  struct Past {
    Pose pose;
    MonoTime moment;
  };
  const Past& newest(std::size_t back = 0) const {
    return past_[(next_ + kKept - 1 - back) % kKept];
  }
  const Past* earlier() const;

  std::array<Past, kKept> past_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace dance
