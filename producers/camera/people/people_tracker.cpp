#include "producers/camera/people/people_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "producers/camera/people/assignment.h"

namespace dance {
namespace {

// In lengths of the body's measure, mean of joints: bodies that are nearer are one.
constexpr float kSameBody = 0.06f;
// Detections nearer than this to the region of somebody who is tracked are that person.
constexpr float kSame_sides = 0.1f;
constexpr float kLeastSide_px = 16.0f;
// Regions nearer than this show parts of each other.
constexpr float kOverlap_sides = 0.25f;
// What is behind another can only be guessed.
constexpr float kCovered = 0.25f;
constexpr float kFrontWeight = 0.2f;

// What a detection costs as a missing person: squares over variances.
constexpr float kPlaceSd_sides = 0.1f, kPlaceSd_sides_per_s = 0.6f, kMostPlace = 12.0f;
constexpr float kSizeSd = 0.2f, kMostSize = 6.0f;
constexpr float kLookWeight = 1.5f;
constexpr std::size_t kMoreCandidates = 2;
constexpr float kStranger = 6.0f, kNobody = 15.0f;
constexpr float kOtherLook = 4.0f;

// Places where colours are looked for, in a region; the middle half of its height.
constexpr int kColourColumns = 48, kColourRows = 28, kLeastColours = 25;
constexpr float kOwnColour = 2.0f, kOthersColour = 5.0f;
// A gap that the solver bridges as one of the same dancer.
constexpr Duration kShortGap = Duration::ms(500);

bool are_one_body(const SeenBody& a, const SeenBody& b) {
  float sum = 0.0f;
  for (const Landmark l : kBodyJoints)
    sum += (a.image_px[index_of(l)] - b.image_px[index_of(l)]).head<2>().norm();
  return sum / static_cast<float>(kBodyJoints.size()) <
         kSameBody * std::max(1.0f, std::min(a.size_px(), b.size_px()));
}

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
    } else if (person && tracks_[i].next()) {
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

// Where across the region most of a person's colours are that nobody else has.
std::optional<float> PeopleTracker::middle_of_colours(PeopleVision& vision, std::size_t person,
                                                      const BodyRegion& region) const {
  const LookModel& own = tracks_[person].look;
  if (!own.is_known()) return std::nullopt;
  std::array<int, kColourColumns> own_places{};
  int count = 0;
  const float left_px = region.centre_x_px - 0.5f * region.side_px,
              top_px = region.centre_y_px - 0.3f * region.side_px;
  const float step_px = region.side_px / static_cast<float>(kColourColumns);
  for (int column = 0; column < kColourColumns; ++column)
    for (int row = 0; row < kColourRows; ++row) {
      const auto colour = vision.colour({left_px + (static_cast<float>(column) + 0.5f) * step_px,
                                         top_px + (static_cast<float>(row) + 0.5f) * step_px});
      if (!colour || own.distance(*colour) > kOwnColour) continue;
      bool is_others = false;
      for (std::size_t i = 0; i < options_.people; ++i)
        if (i != person && found_[i].is_found && tracks_[i].look.is_known() &&
            tracks_[i].look.distance(*colour) < kOthersColour)
          is_others = true;
      if (is_others) continue;
      ++own_places[static_cast<std::size_t>(column)];
      ++count;
    }
  if (count < kLeastColours) return std::nullopt;
  int sum = 0;
  for (int column = 0; column < kColourColumns; ++column) {
    sum += own_places[static_cast<std::size_t>(column)];
    if (2 * sum >= count) return left_px + (static_cast<float>(column) + 0.5f) * step_px;
  }
  return std::nullopt;
}

// Where a missing person is expected, where that one's colours are; later on where another is who
// may be before that one, if the colours are seen there.
std::optional<BodyRegion> PeopleTracker::region_to_probe(PeopleVision& vision, std::size_t person,
                                                         MonoTime now) const {
  const PersonTrack& track = tracks_[person];
  const Duration away = now - track.seen();
  if (!track.was_ever_seen() || away > options_.forget_after || now <= track.seen())
    return std::nullopt;
  BodyRegion region = track.region();
  Eigen::Vector2f middle = track.expected_px(now);
  if (away > options_.probe_for) {
    float least = region.side_px;
    const SeenBody* before = nullptr;
    for (std::size_t i = 0; i < options_.people; ++i) {
      if (i == person || !found_[i].is_found) continue;
      const float apart = (centre_of(found_[i].body.next_region()) - middle).norm();
      if (apart < least) {
        least = apart;
        before = &found_[i].body;
      }
    }
    if (before == nullptr) return std::nullopt;
    middle = centre_of(before->next_region());
  }
  region.centre_x_px = middle.x();
  region.centre_y_px = middle.y();
  const auto middle_px = middle_of_colours(vision, person, region);
  if (middle_px)
    region.centre_x_px = *middle_px;
  else if (away > options_.probe_for)
    return std::nullopt;
  return region;
}

void PeopleTracker::probe_missing(PeopleVision& vision, MonoTime now, const Reads& reads) {
  ReadBody seen;
  for (std::size_t i = 0; i < options_.people; ++i) {
    PersonTrack& track = tracks_[i];
    if (!reads[i] || found_[i].is_found) continue;
    const std::optional<BodyRegion> region = region_to_probe(vision, i, now);
    if (!region || !read(vision, *region, now, std::nullopt, seen) ||
        !track.is_plausible(seen.body.next_region(), now) || is_of_somebody(seen.body))
      continue;
    const auto off =
        track.look.is_known() ? track.look.distance(look_of(seen.body, vision)) : std::nullopt;
    if (off ? *off > kOtherLook : now - track.seen() > options_.probe_for) continue;
    take(i, *region, seen, now - track.seen() > kShortGap);
  }
}

float PeopleTracker::cost_of(std::size_t person, const Candidate& candidate, MonoTime now) const {
  const PersonTrack& track = tracks_[person];
  if (!track.was_ever_seen()) return kStranger;
  const Duration away = now - track.seen();
  const std::optional<float> look =
      track.look.is_known() ? track.look.distance(candidate.look) : std::nullopt;
  float cost = kLookWeight * look.value_or(0.0f);
  // Long away: who comes is another, or looks as this one did.
  if (away > options_.forget_after)
    return look && *look < kOtherLook ? std::min(cost, kStranger) : kStranger;
  const float side = track.region().side_px;
  const float off_sides =
      (centre_of(candidate.region) - track.expected_px(now)).norm() / std::max(1.0f, side);
  const float sd = kPlaceSd_sides + kPlaceSd_sides_per_s * static_cast<float>(away.as_seconds());
  const float size = std::log(candidate.region.side_px / std::max(1.0f, side)) / kSizeSd;
  cost += std::min(off_sides * off_sides / (sd * sd), kMostPlace);
  return cost + std::min(size * size, kMostSize);
}

// From the left to the right, so that persons who were never seen are numbered in this order.
std::size_t PeopleTracker::find_candidates(PeopleVision& vision, MonoTime now, std::size_t wanted) {
  std::size_t count = 0;
  // More than are missing, so that a bystander is in nobody's way; but not the whole street.
  std::size_t may_read = wanted + kMoreCandidates;
  for (const SeenPerson& person : vision.find()) {
    if (count == candidates_.size() || may_read == 0) break;
    bool is_tracked = false;
    for (std::size_t i = 0; i < options_.people; ++i) {
      const SeenBody* other = present(i);
      is_tracked = is_tracked ||
                   (other && (centre_of(other->next_region()) - centre_of(person.region)).norm() <
                                 kSame_sides * person.region.side_px);
    }
    if (is_tracked) continue;
    --may_read;
    Candidate& candidate = candidates_[count];
    if (!read(vision, person.region, now, std::nullopt, candidate.seen) ||
        is_of_somebody(candidate.seen.body))
      continue;
    const bool is_double = std::any_of(
        candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(count),
        [&](const Candidate& c) { return are_one_body(c.seen.body, candidate.seen.body); });
    if (is_double) continue;
    candidate.region = candidate.seen.body.next_region();
    candidate.look = look_of(candidate.seen.body, vision);
    ++count;
  }
  std::sort(candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Candidate& a, const Candidate& b) {
              return a.region.centre_x_px < b.region.centre_x_px;
            });
  return count;
}

void PeopleTracker::search(PeopleVision& vision, MonoTime now, const Reads& reads) {
  std::array<std::size_t, kMostDancers> missing{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < options_.people; ++i)
    if (reads[i] && !found_[i].is_found) missing[count++] = i;
  if (count == 0) return;
  const bool is_due = !last_search_.is_set() || now < last_search_ ||
                      now - last_search_ >= options_.search_interval;
  if (!is_due) return;
  last_search_ = now;
  ++counters_.searches;
  const std::size_t candidates = find_candidates(vision, now, count);
  Assignment::Costs costs{};
  for (std::size_t m = 0; m < count; ++m)
    for (std::size_t c = 0; c < candidates; ++c)
      // Strangers keep the order from the left to the right.
      costs[m][c] = cost_of(missing[m], candidates_[c], now) +
                    0.001f * std::abs(static_cast<float>(m) - static_cast<float>(c));
  const Assignment best(costs, count, candidates, kNobody);
  for (std::size_t m = 0; m < count; ++m) {
    const std::size_t c = best.of(m);
    if (c == Assignment::kNone) continue;
    const std::size_t person = missing[m];
    PersonTrack& track = tracks_[person];
    if (track.was_ever_seen() && now - track.seen() > options_.forget_after) {
      const auto look = track.look.distance(candidates_[c].look);
      if (!look || *look > kOtherLook) {
        forget(person);
      }
    }
    take(person, candidates_[c].region, candidates_[c].seen, true);
  }
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
  reassign_bodies(now);
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
