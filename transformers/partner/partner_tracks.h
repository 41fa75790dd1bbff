// PartnerTracks: the dancers of this house, any of whom a remote guest may dance with.
//
// Units/frames: as transformers/partner/partner_track.h.
// Ownership:    kMost tracks of 20 kB; allocates when a dancer comes, not per pose.
// Threads:      none inside; one owner, whose flows read it.
// Failure:      of more dancers than kMost the last ones are no partners.
#pragma once

#include <memory>
#include <vector>

#include "core/base/guest_id.h"
#include "transformers/partner/partner_track.h"

namespace dance {

class PartnerTracks {
 public:
  static constexpr std::size_t kMost = 8;

  void take(const GuestId& guest, const Pose& pose) {
    if (Dancer* dancer = dancer_of(guest)) dancer->track.take(pose);
  }
  void set_body(const GuestId& guest, const Skeleton& skeleton) {
    if (Dancer* dancer = dancer_of(guest)) dancer->track.set_body(skeleton);
  }
  // In the order in which they came; a place is one dancer's for good.
  std::size_t size() const { return dancers_.size(); }
  const PartnerTrack& operator[](std::size_t place) const { return dancers_[place]->track; }
  const GuestId& guest(std::size_t place) const { return dancers_[place]->guest; }

 private:
  struct Dancer {
    GuestId guest;
    PartnerTrack track;
  };
  Dancer* dancer_of(const GuestId& guest) {
    for (auto& dancer : dancers_)
      if (dancer->guest == guest) return dancer.get();
    if (dancers_.size() == kMost) return nullptr;
    dancers_.push_back(std::make_unique<Dancer>(Dancer{guest, {}}));
    return dancers_.back().get();
  }

  std::vector<std::unique_ptr<Dancer>> dancers_;
};

}  // namespace dance
