#include "producers/camera/estimator/identity_switch_detector.h"

#include <algorithm>

namespace dance {
namespace {

// In sides of the target's region, which are about one and a half times a body's height. A
// detection nearer than this is the target itself.
constexpr float kSame_sides = 0.12f;
// Nearer than the first two people are crossing; farther than the second they are apart again.
constexpr float kCrossing_sides = 0.2f;
constexpr float kPart_sides = 0.24f;
// A switch is assumed only where keeping the target is worse by this factor.
constexpr float kClearly = 2.0f;
// After this long an extrapolation is worthless.
constexpr Duration kCrossingTimeout = Duration::s(6);
constexpr Duration kTrackTimeout = Duration::ms(1500);
constexpr float kSpeedWeight = 0.4f;

float apart(const BodyRegion& a, const Eigen::Vector2f& b) { return (centre_of(a) - b).norm(); }

}  // namespace

Eigen::Vector2f IdentitySwitchDetector::Track::expected(MonoTime now) const {
  return centre_of(region) + static_cast<float>((now - seen).as_seconds()) * speed_px_s;
}

void IdentitySwitchDetector::Track::update(const BodyRegion& is, MonoTime now) {
  if (updates > 0 && now > seen) {
    const Eigen::Vector2f speed =
        (centre_of(is) - centre_of(region)) / static_cast<float>((now - seen).as_seconds());
    speed_px_s = updates == 1 ? speed : speed_px_s + kSpeedWeight * (speed - speed_px_s);
  }
  region = is;
  seen = now;
  ++updates;
}

bool IdentitySwitchDetector::is_due(MonoTime now) const {
  const bool is_alone = other_count_ == 0 && !crossing_;
  return !last_update_ || now < *last_update_ ||
         now - *last_update_ >= (is_alone ? kAlone : kInCompany);
}

std::optional<BodyRegion> IdentitySwitchDetector::update(std::span<const SeenPerson> people,
                                                         const BodyRegion& followed, MonoTime now) {
  last_update_ = now;
  if (crossing_) return resolve(people, followed, now);
  ours_.update(followed, now);
  update_others(people, followed, now);
  if (const Track* other =
          nearest_other(centre_of(followed), kCrossing_sides * followed.side_px, now))
    crossing_ = {ours_, *other};
  return std::nullopt;
}

void IdentitySwitchDetector::on_lost(MonoTime now) {
  if (crossing_ || ours_.updates == 0) return;
  if (const Track* other = nearest_other(centre_of(ours_.region), ours_.region.side_px, now))
    crossing_ = {ours_, *other};
}

const IdentitySwitchDetector::Track* IdentitySwitchDetector::nearest_other(
    const Eigen::Vector2f& place_px, float within_px, MonoTime now) const {
  if (ours_.updates < 2) return nullptr;
  const Track* nearest = nullptr;
  for (const Track& other : std::span(others_.data(), other_count_)) {
    const float distance_px = (other.expected(now) - place_px).norm();
    if (other.updates < 2 || distance_px > within_px) continue;
    within_px = distance_px;
    nearest = &other;
  }
  return nearest;
}

void IdentitySwitchDetector::update_others(std::span<const SeenPerson> people,
                                           const BodyRegion& followed, MonoTime now) {
  const auto kept_end =
      std::remove_if(others_.begin(), others_.begin() + static_cast<std::ptrdiff_t>(other_count_),
                     [&](const Track& track) { return now - track.seen > kTrackTimeout; });
  other_count_ = static_cast<std::size_t>(kept_end - others_.begin());
  for (const SeenPerson& person : people) {
    if (apart(person.region, centre_of(followed)) < kSame_sides * followed.side_px) continue;
    Track* nearest = nullptr;
    float least = kCrossing_sides * followed.side_px;
    for (Track& track : std::span(others_.data(), other_count_)) {
      const float distance = apart(person.region, track.expected(now));
      if (track.seen < now && distance < least) {
        least = distance;
        nearest = &track;
      }
    }
    if (!nearest && other_count_ < others_.size()) {
      nearest = &others_[other_count_++];
      *nearest = {};
    }
    if (nearest) nearest->update(person.region, now);
  }
}

std::optional<BodyRegion> IdentitySwitchDetector::resolve(std::span<const SeenPerson> people,
                                                          const BodyRegion& followed,
                                                          MonoTime now) {
  const Crossing crossing = *crossing_;
  const Eigen::Vector2f is = centre_of(followed);
  const Eigen::Vector2f ours = crossing.ours.expected(now), other = crossing.other.expected(now);
  const SeenPerson* second = nullptr;
  float least = 0.0f;
  for (const SeenPerson& person : people) {
    if (apart(person.region, is) < kPart_sides * followed.side_px) continue;
    const float distance = std::min(apart(person.region, ours), apart(person.region, other));
    if (second && distance >= least) continue;
    second = &person;
    least = distance;
  }
  if (!second) {
    if (now - crossing.ours.seen > kCrossingTimeout) reset();
    return std::nullopt;
  }
  const float straight = (is - ours).norm() + apart(second->region, other);
  const float exchanged = (is - other).norm() + apart(second->region, ours);
  const BodyRegion region = second->region;
  const bool is_exchanged = kClearly * exchanged < straight;
  reset();
  last_update_ = now;
  return is_exchanged ? std::optional(region) : std::nullopt;
}

}  // namespace dance
