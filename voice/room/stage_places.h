// StagePlaces: where the others' dancers stand, seen from the dancer of this house: for the place
// of each voice.
//
// Units/frames: metres and radians on the stage, azimuth 0 ahead of the listener and positive to
//               the left.
// Ownership:    plain value, no heap; remembers kMostDancers; of more, the one unseen the
//               longest has no place.
// Threads:      none inside.
// Failure:      no place where one of the two is not on the stage.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/pose/heading.h"
#include "core/pose/pose.h"

namespace dance {

struct VoicePlace {
  float azimuth_rad = 0.0f;
  float distance_m = 1.0f;
};

class StagePlaces {
 public:
  static constexpr std::size_t kMostDancers = 128;  // as many as a room has

  void see(const GuestId& guest, const Pose& pose) {
    const Dancer seen{guest, pose.p_WH_m, heading_rad(pose.R_PB[0]), ++sightings_};
    for (Dancer& dancer : dancers_) {
      if (dancer.guest != guest) continue;
      dancer = seen;
      return;
    }
    if (dancers_.try_push(seen)) return;
    *std::min_element(dancers_.begin(), dancers_.end(), [](const Dancer& a, const Dancer& b) {
      return a.sighting < b.sighting;
    }) = seen;
  }
  std::optional<VoicePlace> place_of(const GuestId& guest, const GuestId& listener) const {
    const Dancer* from = find(listener);
    const Dancer* to = find(guest);
    if (from == nullptr || to == nullptr || from == to) return std::nullopt;
    const Eigen::Vector3f way = to->p_WH_m - from->p_WH_m;
    const float azimuth = std::atan2(way.x(), way.z()) - from->heading_rad;
    return VoicePlace{std::remainder(azimuth, 2.0f * std::numbers::pi_v<float>),
                      std::hypot(way.x(), way.z())};
  }

 private:
  struct Dancer {
    GuestId guest;
    Eigen::Vector3f p_WH_m = Eigen::Vector3f::Zero();
    float heading_rad = 0.0f;
    std::uint64_t sighting = 0;
  };
  const Dancer* find(const GuestId& guest) const {
    for (const Dancer& dancer : dancers_)
      if (dancer.guest == guest) return &dancer;
    return nullptr;
  }

  FixedList<Dancer, kMostDancers> dancers_;
  std::uint64_t sightings_ = 0;
};

}  // namespace dance
