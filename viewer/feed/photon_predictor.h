// PhotonPredictor: brings the poses of a scene to the moment at which its picture will be seen:
// each guest of whom it is known for what moment the pose stands, by a ShortExtrapolator.
//
// Units/frames: MonoTime of this process.
// Ownership:    room for kMaxGuests; allocates nothing after construction.
// Threads:      none inside; the drawing thread owns it.
// Failure:      none: other guests stay as they came.
#pragma once

#include <span>
#include <vector>

#include "core/motion/short_extrapolator.h"
#include "viewer/feed/stage_roster.h"

namespace dance {

class PhotonPredictor {
 public:
  PhotonPredictor() : guests_(GuestBoard::kMaxGuests) {}

  // The poses that are new in this picture.
  void observe(std::span<const StageRoster::Fresh> fresh);
  void predict(MonoTime photon, SceneState& scene) const;

 private:
  struct Guest {
    GuestId id;
    MonoTime moment;
    ShortExtrapolator motion;
  };
  std::vector<Guest> guests_;
};

}  // namespace dance
