// OneGuest: whom a receiver of one dancer gets: the guest that was asked for, or the first that is
// heard.
//
// Units/frames: none.
// Ownership:    keeps the guest's name and a count.
// Threads:      none inside; one owner.
// Failure:      poses of others are counted.
#pragma once

#include <cstdint>

#include "core/base/guest_id.h"

namespace dance {

class OneGuest {
 public:
  explicit OneGuest(const GuestId& wanted) : guest_(wanted) {}

  bool takes_pose_of(const GuestId& guest) {
    if (takes(guest)) return true;
    ++others_;
    return false;
  }
  // Proportions or hands, which come beside the poses; proportions may be the first that is heard.
  bool takes(const GuestId& guest) {
    if (!guest_.is_set()) guest_ = guest;
    return guest == guest_;
  }
  const GuestId& guest() const { return guest_; }
  std::uint64_t others() const { return others_; }

 private:
  GuestId guest_;
  std::uint64_t others_ = 0;
};

}  // namespace dance
