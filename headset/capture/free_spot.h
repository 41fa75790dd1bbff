// FreeSpot: where a dancer with a headset is put on the stage: on the wanted spot, or, where
// somebody stands there, before that one, face to face; where a couple does, beside it.
//
// Units/frames: metres on the floor of W; headings as core/pose/heading.h.
// Ownership:    room for kMost others; never allocates.
// Threads:      none inside; one owner.
// Failure:      others beyond kMost are not minded; where all round about is full, it is the wanted
//               spot.
#pragma once

#include <array>

#include "core/base/guest_id.h"
#include "core/pose/pose.h"
#include "producers/xr/xr_sensors.h"

namespace dance {

class FreeSpot {
 public:
  static constexpr std::size_t kMost = 32;
  static constexpr Duration kHere = Duration::s(2);  // since the last pose

  void hear(const GuestId& guest, const Pose& pose, MonoTime now);
  XrSpot before(const XrSpot& wanted, MonoTime now) const;

 private:
  struct Other {
    GuestId guest;
    XrSpot spot;
    MonoTime heard;
  };
  const Other* nearest(const XrSpot& spot, MonoTime now) const;
  XrSpot beside(const XrSpot& wanted, MonoTime now) const;

  std::array<Other, kMost> others_{};
};

}  // namespace dance
