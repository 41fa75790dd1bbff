#include "transformers/touch/stage_spacing.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

// A spot is free if no hips are nearer.
constexpr float kFree_m = 0.6f;
constexpr int kMostSpots = 16;
// The offset follows its target without overshoot: 98 % of the way within two seconds.
constexpr float kStiffness_rad_s = 3.0f;
constexpr float kFastest_m_s = 1.0f;
constexpr Duration kLongestStep = Duration::ms(50);

float ground_distance_m(const Vector3f& a, const Vector3f& b) {
  return std::hypot(a.x() - b.x(), a.z() - b.z());
}

bool hold_hands(const StageHolds& holds, const GuestId& a, const GuestId& b) {
  for (std::size_t first = 0; first < 2; ++first)
    for (std::size_t second = 0; second < 2; ++second)
      if (holds.are_held(a, first, b, second)) return true;
  return false;
}

}  // namespace

StageSpacing::Dancer* StageSpacing::place_of(const GuestId& guest, const Pose& pose, MonoTime now,
                                             DancerOf of) {
  for (Dancer& dancer : dancers_)
    if (dancer.guest == guest) return &dancer;
  Dancer* place = find_place(dancers_, of, pose.p_WH_m, now, kGone);
  if (place == nullptr) return nullptr;
  *place = Dancer();
  place->guest = guest;
  place->shown = now;
  return place;
}

// True if `is` holds for a dancer of another house who comes before this one.
template <class Is>
bool StageSpacing::any_before(const Dancer& dancer, MonoTime now, Is is) const {
  return std::any_of(dancers_.begin(), dancers_.end(), [&](const Dancer& other) {
    const bool counts = other.guest.is_set() && other.guest.view() < dancer.guest.view() &&
                        now - other.shown <= kGone &&
                        !(other.of == DancerOf::kThisHouse && dancer.of == DancerOf::kThisHouse);
    return counts && is(other);
  });
}

void StageSpacing::choose_target(Dancer& dancer, MonoTime now, const StageHolds& holds) {
  const bool overlaps = any_before(dancer, now, [&](const Dancer& other) {
    return ground_distance_m(dancer.spot_m(), other.spot_m()) < kOverlap_m &&
           !hold_hands(holds, dancer.guest, other.guest);
  });
  if (!overlaps) dancer.overlapped = MonoTime();
  if (overlaps && !dancer.overlapped.is_set()) dancer.overlapped = now;
  if (overlaps && now - dancer.overlapped >= kOverlapTimeout) {
    dancer.target_m = free_target_m(dancer, now);
    dancer.overlapped = MonoTime();
  }
  const bool is_away = dancer.is_moved() && !any_before(dancer, now, [&](const Dancer& other) {
                         return ground_distance_m(dancer.p_WH_m, other.spot_m()) < kReturn_m ||
                                hold_hands(holds, dancer.guest, other.guest);
                       });
  if (!is_away) dancer.walked_away = MonoTime();
  if (is_away && !dancer.walked_away.is_set()) dancer.walked_away = now;
  if (is_away && now - dancer.walked_away >= kReturnTimeout) dancer.target_m.setZero();
}

// Spots alternate between both sides, +x first; each pair is further away than the last.
Vector3f StageSpacing::free_target_m(const Dancer& dancer, MonoTime now) const {
  for (int spot = 1; spot <= kMostSpots; ++spot) {
    const float side = spot % 2 == 1 ? 1.0f : -1.0f;
    const Vector3f target(side * kApart_m * static_cast<float>((spot + 1) / 2), 0.0f, 0.0f);
    const Vector3f place = dancer.p_WH_m + target;
    if (!any_before(dancer, now, [&](const Dancer& other) {
          return ground_distance_m(place, other.spot_m()) < kFree_m;
        }))
      return target;
  }
  return dancer.target_m;
}

void StageSpacing::apply(const GuestId& guest, Pose& pose, MonoTime now, DancerOf of,
                         const StageHolds& holds) {
  Dancer* dancer = place_of(guest, pose, now, of);
  if (dancer == nullptr) return;
  const auto step_s =
      static_cast<float>(std::clamp(now - dancer->shown, Duration(), kLongestStep).as_seconds());
  dancer->of = of;
  dancer->p_WH_m = pose.p_WH_m;
  dancer->shown = now;
  choose_target(*dancer, now, holds);
  // Critically damped.
  const Vector3f pull_m_s2 =
      kStiffness_rad_s * kStiffness_rad_s * (dancer->target_m - dancer->offset_m) -
      2.0f * kStiffness_rad_s * dancer->speed_m_s;
  dancer->speed_m_s += step_s * pull_m_s2;
  const float speed = dancer->speed_m_s.norm();
  if (speed > kFastest_m_s) dancer->speed_m_s *= kFastest_m_s / speed;
  dancer->offset_m += step_s * dancer->speed_m_s;
  pose.p_WH_m += dancer->offset_m;
}

}  // namespace dance
