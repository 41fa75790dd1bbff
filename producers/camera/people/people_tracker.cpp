#include "producers/camera/people/people_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "producers/camera/people/person_costs.h"

namespace dance {
namespace {

constexpr float kLeastSide_px = 16.0f;
// Regions nearer than this show parts of each other.
constexpr float kOverlap_sides = 0.25f;
// What is behind another can only be guessed.
constexpr float kCovered = 0.25f;
constexpr float kFrontWeight = 0.2f;

float lowest_px(const SeenBody& body) {
  return std::max(body.image_px[index_of(Landmark::kLeftAnkle)].y(),
                  body.image_px[index_of(Landmark::kRightAnkle)].y());
}

}  // namespace

void PeopleTracker::reset() {
  tracks_.fill({});
  limbs_.fill({});
  evidence_ = {};
  doubt_ = {};
  lowest_px_ = {};
  is_left_out_ = {};
  last_search_ = {};
}

void PeopleTracker::lose_all() {
  for (PersonTrack& track : tracks_) track.lose();
  last_search_ = {};
}

void PeopleTracker::forget(std::size_t person) {
  tracks_[person].reset();
  limbs_[person].reset();
  doubt_[person] = lowest_px_[person] = 0.0f;
  for (std::size_t i = 0; i < kMostDancers; ++i) evidence_[i][person] = evidence_[person][i] = 0.0f;
}

const SeenBody* PeopleTracker::present(std::size_t person) const {
  return found_[person].is_found || is_left_out_[person] ? &found_[person].body : nullptr;
}

// Those who have been found already are nearer to the camera: the others are read without them. Who
// is read next is not looked at either, but for where the first covers that one.
bool PeopleTracker::read(PeopleVision& vision, const BodyRegion& region, MonoTime now,
                         std::optional<std::size_t> person, ReadBody& out) {
  if (!(region.side_px >= kLeastSide_px)) return false;
  ++counters_.reads;
  std::array<const SeenBody*, kMostDancers> before{}, behind{};
  std::array<std::optional<SeenBody>, kMostDancers> expected;
  std::size_t count_before = 0, count_behind = 0;
  const auto overlaps = [&](const SeenBody& other) {
    return (centre_of(other.next_region()) - centre_of(region)).norm() <
           kOverlap_sides * region.side_px;
  };
  for (std::size_t i = 0; i < options_.people; ++i) {
    if (const SeenBody* other = present(i)) {
      if (overlaps(*other)) before[count_before++] = other;
    } else if (person) {
      expected[i] = tracks_[i].expected_body(now);
      if (i != *person && expected[i] && overlaps(*expected[i]))
        behind[count_behind++] = &*expected[i];
    }
  }
  OtherPeople others;
  others.before = std::span(before.data(), count_before);
  if (person && expected[*person]) {
    others.own = &*expected[*person];
    others.behind = std::span(behind.data(), count_behind);
  }
  return vision.read(region, others, out) && out.body.presence > options_.least_presence &&
         out.body.next_region().side_px >= kLeastSide_px;
}

std::array<std::size_t, kMostDancers> PeopleTracker::from_front() const {
  std::array<std::size_t, kMostDancers> order{};
  for (std::size_t i = 0; i < kMostDancers; ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return lowest_px_[a] > lowest_px_[b]; });
  return order;
}

void PeopleTracker::take(std::size_t person, const BodyRegion& region, const ReadBody& seen,
                         bool is_new) {
  PersonInPicture& found = found_[person];
  found.is_found = true;
  found.is_new = is_new;
  found.region = region;
  found.body = seen.body;
  found.is_covered = seen.is_covered;
}

void PeopleTracker::read_tracked(PeopleVision& vision, MonoTime now, const Reads& reads) {
  ReadBody seen;
  for (const std::size_t i : from_front()) {
    if (i >= options_.people) continue;
    // Without pictures for so long anybody may be there.
    if (now - tracks_[i].seen() > options_.probe_for) tracks_[i].lose();
    const std::optional<BodyRegion> region = tracks_[i].next();
    if (!reads[i] || !region) continue;
    if (read(vision, *region, now, i, seen) &&
        tracks_[i].is_plausible(seen.body.next_region(), now))
      take(i, *region, seen, false);
    else
      tracks_[i].lose();
  }
}

// Two regions that have come to one body: it is that person's whom it looks like and who was
// expected there. The other is hidden.
void PeopleTracker::separate_duplicates(PeopleVision& vision, MonoTime now) {
  for (std::size_t a = 0; a < options_.people; ++a)
    for (std::size_t b = a + 1; b < options_.people; ++b) {
      const SeenBody *first = present(a), *second = present(b);
      if (!first || !second || !are_one_body(*first, *second)) continue;
      ++counters_.duplicates;
      const auto against = [&](std::size_t i) {
        const SeenBody& body = found_[i].body;
        const BodyRegion is = body.next_region();
        const float off = (centre_of(is) - tracks_[i].expected_px(now)).norm() /
                          (kPlaceSd_sides * std::max(1.0f, tracks_[i].region().side_px));
        const float look = tracks_[i].look.is_known()
                               ? tracks_[i].look.distance(look_of(body, vision)).value_or(0.0f)
                               : 0.0f;
        return std::min(off * off, kMostPlace) + kLookWeight * look;
      };
      const std::size_t hidden = against(a) > against(b) ? a : b;
      found_[hidden].is_found = is_left_out_[hidden] = false;
      tracks_[hidden].lose();
    }
}

bool PeopleTracker::is_of_somebody(const SeenBody& body) const {
  for (std::size_t i = 0; i < options_.people; ++i)
    if (const SeenBody* other = present(i); other && are_one_body(*other, body)) return true;
  return false;
}

void PeopleTracker::resolve_all_limbs(MonoTime now) {
  std::array<LimbClaimant, kMostDancers> claimants;
  std::size_t front = 0;
  for (std::size_t i = 0; i < options_.people; ++i) {
    if (!found_[i].is_found) continue;
    claimants[i] = {&found_[i].body, &limbs_[i], false};
    if (!claimants[front].body || lowest_px(found_[i].body) > lowest_px(found_[front].body))
      front = i;
  }
  claimants[front].is_in_front = true;
  counters_.limbs_hidden +=
      static_cast<std::uint64_t>(resolve_limbs(std::span(claimants.data(), options_.people), now));
}

void PeopleTracker::hide_covered() {
  for (std::size_t i = 0; i < options_.people; ++i)
    for (std::size_t l = 0; found_[i].is_found && l < kLandmarkCount; ++l) {
      float& visibility = found_[i].body.visibility[l];
      if (found_[i].is_covered[l]) visibility = std::min(visibility, kCovered);
    }
}

std::span<const PersonInPicture> PeopleTracker::update(PeopleVision& vision, MonoTime now,
                                                       const Reads& reads) {
  ++counters_.pictures;
  for (std::size_t i = 0; i < kMostDancers; ++i) {
    found_[i].is_found = found_[i].is_new = false;
    is_left_out_[i] = i < options_.people && !reads[i] && tracks_[i].next().has_value();
  }
  read_tracked(vision, now, reads);
  reassign_bodies(now, reads);
  separate_duplicates(vision, now);
  probe_missing(vision, now, reads);
  search(vision, now, reads);
  judge_identities(vision, now);
  resolve_all_limbs(now);
  hide_covered();
  for (std::size_t i = 0; i < options_.people; ++i) {
    if (!found_[i].is_found) continue;
    tracks_[i].update(found_[i].body, now);
    limbs_[i].update(found_[i].body, now);
    const float lowest = lowest_px(found_[i].body);
    lowest_px_[i] =
        found_[i].is_new ? lowest : lowest_px_[i] + kFrontWeight * (lowest - lowest_px_[i]);
  }
  return std::span(found_.data(), options_.people);
}

}  // namespace dance
