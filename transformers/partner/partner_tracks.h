// PartnerTracks: the dancers of this house, any of whom a remote guest may dance with.
//
// Units/frames: as transformers/partner/partner_track.h.
// Ownership:    kMost tracks of 20 kB; allocates when a dancer comes, not per pose.
// Threads:      none inside; one owner, whose flows read it.
// Failure:      of more dancers than kMost at a time the last ones are no partners, and counted.
#pragma once

#include <memory>
#include <vector>

#include "core/base/guest_id.h"
#include "transformers/partner/partner_track.h"

namespace dance {

class PartnerTracks {
 public:
  static constexpr std::size_t kMost = 8;
  // Who was not seen for so long gives the place to a newcomer.
  static constexpr Duration kGone = Duration::s(60);

  // `body`: the proportions where they are known; of a newcomer they are looked at alone.
  void take(const GuestId& guest, const Pose& pose, const Skeleton* body = nullptr) {
    if (Dancer* dancer = dancer_of(guest, pose.capture_time, body)) dancer->track.take(pose);
  }
  // Of a dancer who has danced; others' are told with their first pose.
  void set_body(const GuestId& guest, const Skeleton& skeleton) {
    for (auto& dancer : dancers_)
      if (dancer->guest == guest) dancer->track.set_body(skeleton);
  }
  std::size_t size() const { return dancers_.size(); }
  const PartnerTrack& operator[](std::size_t place) const { return dancers_[place]->track; }
  const GuestId& guest(std::size_t place) const { return dancers_[place]->guest; }
  // Counts the dancers who have had that place.
  std::uint32_t generation(std::size_t place) const { return dancers_[place]->generation; }
  // Poses of more dancers than kMost.
  std::uint64_t refused() const { return refused_; }

 private:
  struct Dancer {
    GuestId guest;
    PartnerTrack track;
    std::uint32_t generation = 0;
  };
  Dancer* dancer_of(const GuestId& guest, MonoTime now, const Skeleton* body) {
    Dancer* silent = nullptr;
    for (auto& dancer : dancers_) {
      if (dancer->guest == guest) return dancer.get();
      const bool is_gone = dancer->track.is_empty() || now - dancer->track.newest().time > kGone;
      if (is_gone) silent = dancer.get();
    }
    if (dancers_.size() < kMost) {
      dancers_.push_back(std::make_unique<Dancer>());
      silent = dancers_.back().get();
    }
    if (!silent) {
      ++refused_;
      return nullptr;
    }
    silent->guest = guest;
    silent->track = PartnerTrack();
    ++silent->generation;
    if (body) silent->track.set_body(*body);
    return silent;
  }

  std::vector<std::unique_ptr<Dancer>> dancers_;
  std::uint64_t refused_ = 0;
};

}  // namespace dance
