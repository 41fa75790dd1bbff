#include "producers/camera/estimator/people_watch.h"

#include <algorithm>

namespace dance {
namespace {

// In sides of the region of the one who is followed, which are about one and a half times a body's
// height. A detection nearer than this is that one's own.
constexpr float kSame_sides = 0.12f;
// Who comes as near as this is met; who is as far as this has parted.
constexpr float kMeet_sides = 0.2f;
constexpr float kPart_sides = 0.24f;
// Somebody else is only taken where the other way round is as much worse.
constexpr float kClearly = 2.0f;
// Motion from before is no guess any more.
constexpr Duration kLongest = Duration::s(6);
constexpr Duration kGone = Duration::ms(1500);
constexpr float kWalkWeight = 0.4f;

float apart(const BodyRegion& a, const Eigen::Vector2f& b) { return (centre_of(a) - b).norm(); }

}  // namespace

Eigen::Vector2f PeopleWatch::Walker::expected(MonoTime now) const {
  return centre_of(region) + static_cast<float>((now - seen).as_seconds()) * speed_px_s;
}

void PeopleWatch::Walker::see(const BodyRegion& is, MonoTime now) {
  if (looks > 0 && now > seen) {
    const Eigen::Vector2f speed =
        (centre_of(is) - centre_of(region)) / static_cast<float>((now - seen).as_seconds());
    speed_px_s = looks == 1 ? speed : speed_px_s + kWalkWeight * (speed - speed_px_s);
  }
  region = is;
  seen = now;
  ++looks;
}

bool PeopleWatch::is_due(MonoTime now) const {
  const bool is_alone = other_count_ == 0 && !meeting_;
  return !last_look_ || now < *last_look_ || now - *last_look_ >= (is_alone ? kAlone : kInCompany);
}

std::optional<BodyRegion> PeopleWatch::look(std::span<const SeenPerson> people,
                                            const BodyRegion& followed, MonoTime now) {
  last_look_ = now;
  if (meeting_) return part(people, followed, now);
  ours_.see(followed, now);
  note_others(people, followed, now);
  if (const Walker* other = nearest_other(centre_of(followed), kMeet_sides * followed.side_px, now))
    meeting_ = {ours_, *other};
  return std::nullopt;
}

void PeopleWatch::lose(MonoTime now) {
  if (meeting_ || ours_.looks == 0) return;
  if (const Walker* other = nearest_other(centre_of(ours_.region), ours_.region.side_px, now))
    meeting_ = {ours_, *other};
}

const PeopleWatch::Walker* PeopleWatch::nearest_other(const Eigen::Vector2f& place_px,
                                                      float within_px, MonoTime now) const {
  if (ours_.looks < 2) return nullptr;
  const Walker* nearest = nullptr;
  for (const Walker& other : std::span(others_.data(), other_count_)) {
    const float distance_px = (other.expected(now) - place_px).norm();
    if (other.looks < 2 || distance_px > within_px) continue;
    within_px = distance_px;
    nearest = &other;
  }
  return nearest;
}

void PeopleWatch::note_others(std::span<const SeenPerson> people, const BodyRegion& followed,
                              MonoTime now) {
  const auto gone =
      std::remove_if(others_.begin(), others_.begin() + static_cast<std::ptrdiff_t>(other_count_),
                     [&](const Walker& walker) { return now - walker.seen > kGone; });
  other_count_ = static_cast<std::size_t>(gone - others_.begin());
  for (const SeenPerson& person : people) {
    if (apart(person.region, centre_of(followed)) < kSame_sides * followed.side_px) continue;
    Walker* nearest = nullptr;
    float least = kMeet_sides * followed.side_px;
    for (Walker& walker : std::span(others_.data(), other_count_)) {
      const float distance = apart(person.region, walker.expected(now));
      if (walker.seen < now && distance < least) {
        least = distance;
        nearest = &walker;
      }
    }
    if (!nearest && other_count_ < others_.size()) {
      nearest = &others_[other_count_++];
      *nearest = {};
    }
    if (nearest) nearest->see(person.region, now);
  }
}

std::optional<BodyRegion> PeopleWatch::part(std::span<const SeenPerson> people,
                                            const BodyRegion& followed, MonoTime now) {
  const Meeting met = *meeting_;
  const Eigen::Vector2f is = centre_of(followed);
  const Eigen::Vector2f ours = met.ours.expected(now), other = met.other.expected(now);
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
    if (now - met.ours.seen > kLongest) forget();
    return std::nullopt;
  }
  const float straight = (is - ours).norm() + apart(second->region, other);
  const float exchanged = (is - other).norm() + apart(second->region, ours);
  const BodyRegion region = second->region;
  const bool is_exchanged = kClearly * exchanged < straight;
  forget();
  last_look_ = now;
  return is_exchanged ? std::optional(region) : std::nullopt;
}

}  // namespace dance
