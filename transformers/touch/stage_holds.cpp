#include "transformers/touch/stage_holds.h"

#include <algorithm>

#include "core/motion/palm_pull.h"
#include "transformers/touch/hand_reach.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// A palm is extrapolated from where it was shown, for at most a picture of a slow stage.
constexpr Duration kFurthestOn = Duration::ms(34);
constexpr Duration kSpeedWithin = Duration::ms(100);
constexpr float kFastestPalm_m_s = 8.0f;
// The new speed's part: pictures are 8 to 17 ms apart.
constexpr float kPalmSpeedPart = 0.3f;
// Arms reach over gaps up to kReachesWhole_m whole, and not at all over kReachesNot_m.
constexpr float kReachesWhole_m = 0.2f, kReachesNot_m = 0.35f;

float reach_share(float apart_m) {
  return std::clamp((kReachesNot_m - apart_m) / (kReachesNot_m - kReachesWhole_m), 0.0f, 1.0f);
}

}  // namespace

StageHolds::StageHolds() {
  for (Dancer& dancer : dancers_) {
    dancer.skeleton = average_skeleton();
    dancer.palms.fill(Vector3f::Zero());
    dancer.speed_m_s.fill(Vector3f::Zero());
  }
}

Vector3f StageHolds::Dancer::palm_at(std::size_t side, MonoTime now) const {
  const Duration on = std::clamp(now - shown, Duration(), kFurthestOn);
  return palms[side] + static_cast<float>(on.as_seconds()) * speed_m_s[side];
}

const StageHolds::Dancer* StageHolds::find(const GuestId& guest) const {
  for (const Dancer& dancer : dancers_)
    if (dancer.guest == guest) return &dancer;
  return nullptr;
}

StageHolds::Dancer* StageHolds::place_of(const GuestId& guest, const Pose& pose, MonoTime now,
                                         DancerOf of) {
  for (Dancer& dancer : dancers_)
    if (dancer.guest == guest) return &dancer;
  Dancer* place = find_place(dancers_, of, pose.p_WH_m, now, kGone);
  if (!place) {
    ++refused_;
    return nullptr;
  }
  leave(static_cast<std::size_t>(place - dancers_.data()));
  place->guest = guest;
  place->skeleton = average_skeleton();
  place->shown = MonoTime();
  place->reaches = false;
  return place;
}

void StageHolds::leave(std::size_t place) {
  for (std::size_t other = 0; other < kMostDancers; ++other)
    if (other != place) pairs_[pair_index(std::min(place, other), std::max(place, other))] = Pair();
}

void StageHolds::set_body(const GuestId& guest, const Skeleton& skeleton) {
  for (Dancer& dancer : dancers_)
    if (dancer.guest == guest) dancer.skeleton = skeleton;
}

void StageHolds::note(Dancer& dancer, const Palms& palms, MonoTime now) const {
  const Duration since = now - dancer.shown;
  const bool goes_on = dancer.shown.is_set() && since > Duration() && since < kSpeedWithin;
  for (std::size_t side = 0; side < 2; ++side) {
    Vector3f& speed = dancer.speed_m_s[side];
    if (goes_on) {
      const Vector3f newest = (palms[side] - dancer.palms[side]) /
                              static_cast<float>(std::max(since, Duration::ms(4)).as_seconds());
      speed += kPalmSpeedPart * (newest - speed);
      const float size = speed.norm();
      if (size > kFastestPalm_m_s) speed *= kFastestPalm_m_s / size;
    } else if (since >= kSpeedWithin) {
      speed.setZero();
    }
    dancer.palms[side] = palms[side];
  }
  dancer.shown = now;
}

void StageHolds::hold(std::size_t own, std::size_t other, MonoTime now, Reach& reach) {
  const Dancer &dancer = dancers_[own], &partner = dancers_[other];
  Pair& pair = pairs_[pair_index(std::min(own, other), std::max(own, other))];
  if (now - partner.shown > kGone) {
    pair = Pair();
    return;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t own_side = own < other ? k / 2 : k % 2;
    const std::size_t other_side = own < other ? k % 2 : k / 2;
    const Vector3f apart = partner.palm_at(other_side, now) - dancer.palms[own_side];
    const float apart_m = apart.norm();
    pair[k].observe(own < other ? apart : Vector3f(-apart), now, limits_);
    // Half of the way, unless the other's arms do not reach.
    const float weight = pair[k].share() * reach_share(apart_m);
    if (weight <= reach.weight[own_side]) continue;
    reach.weight[own_side] = weight;
    reach.shift[own_side] = weight * (partner.reaches ? 0.5f : 1.0f) * apart;
  }
}

bool StageHolds::show(const GuestId& guest, Pose& pose, MonoTime now, bool reaches, DancerOf of) {
  Dancer* dancer = place_of(guest, pose, now, of);
  if (!dancer) return false;
  dancer->of = of;
  dancer->p_WH_m = pose.p_WH_m;
  dancer->reaches = reaches;
  BodyFrames frames;
  forward_kinematics(dancer->skeleton, pose, frames);
  const Palms palms{palm_of(dancer->skeleton, frames, 0), palm_of(dancer->skeleton, frames, 1)};
  if (!palms[0].allFinite() || !palms[1].allFinite()) return false;
  note(*dancer, palms, now);
  Reach reach;
  reach.shift.fill(Vector3f::Zero());
  const auto own = static_cast<std::size_t>(dancer - dancers_.data());
  for (std::size_t other = 0; other < kMostDancers; ++other)
    if (other != own && dancers_[other].guest.is_set()) hold(own, other, now, reach);
  if (!reaches) return false;
  bool has_moved = false;
  for (std::size_t side = 0; side < 2; ++side) {
    if (reach.weight[side] <= 0.0f) continue;
    move_hand(side, reach.shift[side], pose, frames);
    has_moved = true;
  }
  return has_moved;
}

bool StageHolds::are_held(const GuestId& first, std::size_t first_side, const GuestId& second,
                          std::size_t second_side) const {
  const Dancer *one = find(first), *two = find(second);
  if (!one || !two || one == two || !first.is_set() || !second.is_set()) return false;
  if (one < two)
    return pair(static_cast<std::size_t>(one - dancers_.data()),
                static_cast<std::size_t>(two - dancers_.data()))[2 * first_side + second_side]
        .is_held();
  return pair(static_cast<std::size_t>(two - dancers_.data()),
              static_cast<std::size_t>(one - dancers_.data()))[2 * second_side + first_side]
      .is_held();
}

}  // namespace dance
