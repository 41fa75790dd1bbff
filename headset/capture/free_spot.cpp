#include "headset/capture/free_spot.h"

#include <cmath>
#include <numbers>

#include "core/pose/heading.h"

namespace dance {
namespace {

constexpr float kTooNear_m = 0.8f;
constexpr float kFaceToFace_m = 1.1f;
constexpr int kTries = 4;  // a couple stands before each other
constexpr int kRings = 4, kPlacesOfRing = 8;
constexpr float kPi = std::numbers::pi_v<float>;

float distance_m(const XrSpot& a, const XrSpot& b) {
  return std::hypot(a.x_m - b.x_m, a.z_m - b.z_m);
}

}  // namespace

void FreeSpot::hear(const GuestId& guest, const Pose& pose, MonoTime now) {
  Other* place = nullptr;
  for (Other& other : others_) {
    if (other.guest == guest) {
      place = &other;
      break;
    }
    const bool is_free = !other.guest.is_set() || now - other.heard > kHere;
    if (place == nullptr && is_free) place = &other;
  }
  if (place == nullptr) return;
  *place = {guest, {pose.p_WH_m.x(), pose.p_WH_m.z(), heading_rad(pose.R_PB[0])}, now};
}

const FreeSpot::Other* FreeSpot::nearest(const XrSpot& spot, MonoTime now) const {
  const Other* best = nullptr;
  for (const Other& other : others_) {
    if (!other.guest.is_set() || now - other.heard > kHere) continue;
    if (distance_m(other.spot, spot) > kTooNear_m) continue;
    if (best == nullptr || distance_m(other.spot, spot) < distance_m(best->spot, spot))
      best = &other;
  }
  return best;
}

XrSpot FreeSpot::before(const XrSpot& wanted, MonoTime now) const {
  XrSpot spot = wanted;
  for (int i = 0; i < kTries; ++i) {
    const Other* other = nearest(spot, now);
    if (other == nullptr) return spot;
    const float heading = other->spot.heading_rad;
    spot.x_m = other->spot.x_m + kFaceToFace_m * std::sin(heading);
    spot.z_m = other->spot.z_m + kFaceToFace_m * std::cos(heading);
    spot.heading_rad = heading + kPi;
  }
  return beside(wanted, now);
}

// The nearest free one round about, looking at the wanted one.
XrSpot FreeSpot::beside(const XrSpot& wanted, MonoTime now) const {
  for (int ring = 1; ring <= kRings; ++ring)
    for (int i = 0; i < kPlacesOfRing; ++i) {
      const float away = kFaceToFace_m * static_cast<float>(ring);
      const float to_rad = wanted.heading_rad + 2.0f * kPi * static_cast<float>(i) / kPlacesOfRing;
      const XrSpot spot{wanted.x_m + away * std::sin(to_rad), wanted.z_m + away * std::cos(to_rad),
                        to_rad + kPi};
      if (nearest(spot, now) == nullptr) return spot;
    }
  return wanted;
}

}  // namespace dance
