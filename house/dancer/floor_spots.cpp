#include "house/dancer/floor_spots.h"

#include <cmath>
#include <numbers>

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kRing_m = 2.4f;          // from ring to ring
constexpr std::size_t kOnFirstRing = 6;  // and 6 more on each further ring
// Poses of all who are in a room arrive within this time after the house has joined it.
constexpr Duration kFirstSight = Duration::s(1);
// Two timeouts differ by more than a glide (0.7 s) and the delay of a pose (0.25 s) take.
constexpr Duration kNewcomers = Duration::ms(400);
constexpr Duration kNewcomersWithEarlierName = Duration::ms(1400);
constexpr Duration kResidents = Duration::ms(2400);
constexpr Duration kResidentsWithEarlierName = Duration::ms(3400);
constexpr Duration kMoreWithChosenRole = Duration::s(5);

float distance_m(const Vector3f& a, const Vector3f& b) {
  return std::hypot(a.x() - b.x(), a.z() - b.z());
}

std::size_t index_of(SalsaRole role) { return role == SalsaRole::kLead ? 0 : 1; }

}  // namespace

Vector3f couple_middle_m(std::size_t couple) {
  if (couple == 0) return Vector3f::Zero();
  std::size_t ring = 1, place = couple - 1;
  while (place >= ring * kOnFirstRing) place -= kOnFirstRing * ring++;
  const float turn_rad = 2.0f * std::numbers::pi_v<float> * static_cast<float>(place) /
                         static_cast<float>(ring * kOnFirstRing);
  const float radius_m = kRing_m * static_cast<float>(ring);
  return {radius_m * std::sin(turn_rad), 0.0f, radius_m * std::cos(turn_rad)};
}

FloorSpots::FloorSpots(const GuestId& own, std::optional<SalsaRole> chosen, MonoTime start)
    : own_(own), chosen_(chosen), arrival_(start), spot_{chosen.value_or(SalsaRole::kLead), 0} {}

void FloorSpots::choose(std::optional<SalsaRole> role) {
  chosen_ = role;
  if (role) spot_.role = *role;
}

void FloorSpots::arrive(MonoTime now) { arrival_ = now; }

void FloorSpots::update_other(const GuestId& guest, const Vector3f& p_WH_m, MonoTime now) {
  if (guest == own_) return;
  for (Other& other : others_) {
    if (other.guest != guest) continue;
    other.p_WH_m = p_WH_m;
    other.seen = now;
    return;
  }
  for (std::size_t i = others_.size(); i-- > 0;)
    if (now - others_[i].seen > kGone) others_.erase_at(i);
  (void)others_.try_push({guest, p_WH_m, now, now - arrival_ < kFirstSight, MonoTime()});
}

Duration FloorSpots::overlap_timeout(const Other& other) const {
  const bool is_newcomer = other.overlap - arrival_ < kNewcomer;
  if (is_newcomer && other.was_here && !chosen_) return Duration();
  const bool is_earlier = own_ < other.guest;
  const Duration timeout = is_newcomer ? (is_earlier ? kNewcomersWithEarlierName : kNewcomers)
                                       : (is_earlier ? kResidentsWithEarlierName : kResidents);
  return chosen_ ? timeout + kMoreWithChosenRole : timeout;
}

std::optional<FloorSpot> FloorSpots::free_spot(const std::array<Vector3f, 2>& hips_m) const {
  for (std::size_t couple = 0; couple < kFloorCouples; ++couple)
    for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow}) {
      if (chosen_ && role != *chosen_) continue;
      const Vector3f place = couple_middle_m(couple) + hips_m[index_of(role)];
      bool is_free = true;
      for (const Other& other : others_)
        if (other.seen.is_set() && distance_m(other.p_WH_m, place) < kFree_m) is_free = false;
      if (is_free) return FloorSpot{role, couple};
    }
  return std::nullopt;
}

const FloorSpot& FloorSpots::update(const std::array<Vector3f, 2>& hips_m, MonoTime now) {
  const Vector3f own = couple_middle_m(spot_.couple) + hips_m[index_of(spot_.role)];
  bool moves = false;
  for (std::size_t i = others_.size(); i-- > 0;) {
    Other& other = others_[i];
    if (now - other.seen > kGone) {
      others_.erase_at(i);
    } else if (distance_m(other.p_WH_m, own) >= kOverlap_m) {
      other.overlap = MonoTime();
    } else {
      if (!other.overlap.is_set()) other.overlap = now;
      moves |= now - other.overlap >= overlap_timeout(other);
    }
  }
  if (!moves) return spot_;
  if (const auto spot = free_spot(hips_m)) {
    spot_ = *spot;
    for (Other& other : others_) {
      other.overlap = MonoTime();
      other.was_here = false;
    }
  }
  return spot_;
}

}  // namespace dance
