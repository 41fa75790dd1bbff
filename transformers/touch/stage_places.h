// Which dancers of a stage have one of the places in which hands hold and bodies touch: those of
// this house first, then those nearest to them.
//
// Units/frames: metres in W; times of this house's clock.
// Ownership:    the caller's array; never allocates.
// Threads:      none inside.
// Failure:      find_place() gives none where all places are of dancers that matter more.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/base/guest_id.h"
#include "core/pose/kinematics.h"

namespace dance {

enum class DancerOf : std::uint8_t { kThisHouse, kAnother };

struct StagePlace {
  GuestId guest;  // not set: a free place
  DancerOf of = DancerOf::kAnother;
  Eigen::Vector3f p_WH_m = Eigen::Vector3f::Zero();
  MonoTime shown;
};

// A remote dancer takes the place of one who is so much further away, so that two at the same
// distance do not take it from each other.
constexpr float kPlaceNearer_m = 0.5f;

// How far the nearest dancer of this house is; infinite where nobody dances here.
template <class Place, std::size_t N>
float distance_from_house_m(const std::array<Place, N>& places, const Eigen::Vector3f& p_WH_m,
                            MonoTime now, Duration gone) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const Place& place : places) {
    if (!place.guest.is_set() || place.of != DancerOf::kThisHouse || now - place.shown > gone)
      continue;
    const float distance = (place.p_WH_m - p_WH_m).norm();
    if (distance < nearest) nearest = distance;
  }
  return nearest;
}

// The place of a guest who has none yet; null: there is none. What it held must be cleared.
template <class Place, std::size_t N>
Place* find_place(std::array<Place, N>& places, DancerOf of, const Eigen::Vector3f& p_WH_m,
                  MonoTime now, Duration gone) {
  Place* left = nullptr;
  for (Place& place : places) {
    if (!place.guest.is_set()) return &place;
    if (now - place.shown > gone) left = &place;
  }
  if (left) return left;
  Place* furthest = nullptr;
  float furthest_m = -1.0f;
  for (Place& place : places) {
    if (place.of == DancerOf::kThisHouse) continue;
    const float distance = distance_from_house_m(places, place.p_WH_m, now, gone);
    if (!(distance > furthest_m)) continue;
    furthest = &place;
    furthest_m = distance;
  }
  if (of == DancerOf::kThisHouse) return furthest;
  const float own_m = distance_from_house_m(places, p_WH_m, now, gone);
  return own_m + kPlaceNearer_m < furthest_m ? furthest : nullptr;
}

}  // namespace dance
