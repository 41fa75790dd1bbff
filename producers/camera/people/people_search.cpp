// Looks for those who are missing: the part of PeopleTracker that finds them again, where they are
// expected or in the whole picture.
#include <algorithm>
#include <cmath>

#include "producers/camera/people/assignment.h"
#include "producers/camera/people/people_tracker.h"
#include "producers/camera/people/person_costs.h"

namespace dance {
namespace {

// Detections nearer than this to the region of somebody who is tracked are that person.
constexpr float kSame_sides = 0.1f;

// What a detection costs as a missing person, beside person_costs.h.
constexpr float kPlaceSd_sides_per_s = 0.6f, kSizeSd = 0.2f, kMostSize = 6.0f;
constexpr float kStranger = 6.0f, kNobody = 15.0f, kNever = 1000.0f;
constexpr std::size_t kMoreCandidates = 2;
constexpr float kOtherLook = 4.0f;

// Places where colours are looked for, in a region; the middle half of its height.
constexpr int kColourColumns = 48, kColourRows = 28, kLeastColours = 25;
constexpr float kOwnColour = 2.0f, kOthersColour = 5.0f;
// A gap that the solver bridges as one of the same dancer.
constexpr Duration kShortGap = Duration::ms(500);

}  // namespace

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

float PeopleTracker::cost_of(std::size_t person, const Candidate& candidate, MonoTime now,
                             bool only_by_look) const {
  const PersonTrack& track = tracks_[person];
  if (!track.was_ever_seen()) return kStranger;
  const Duration away = now - track.seen();
  const std::optional<float> look =
      track.look.is_known() ? track.look.distance(candidate.look) : std::nullopt;
  if (only_by_look && !(look && *look < kOtherLook)) return kNever;
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
std::size_t PeopleTracker::find_candidates(PeopleVision& vision, MonoTime now, std::size_t wanted,
                                           bool only_by_look) {
  std::size_t count = 0;
  // More than are missing, so that a bystander is in nobody's way; but not the whole street.
  std::size_t may_read = wanted + kMoreCandidates;
  std::array<const SeenBody*, kMostDancers> tracked{};
  std::size_t count_tracked = 0;
  for (std::size_t i = 0; i < options_.people; ++i)
    if (const SeenBody* other = present(i)) tracked[count_tracked++] = other;
  const std::span<const SeenBody* const> others(tracked.data(), count_tracked);
  for (const SeenPerson& person :
       vision.find(only_by_look ? others : std::span<const SeenBody* const>())) {
    if (count == candidates_.size() || may_read == 0) break;
    const auto is_at = [&](const SeenBody* other) {
      return (centre_of(other->next_region()) - centre_of(person.region)).norm() <
             kSame_sides * person.region.side_px;
    };
    if (!only_by_look && std::any_of(others.begin(), others.end(), is_at)) continue;
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
  // What is left of a body that is painted over, or its shadow, wears nobody's clothes. After long
  // who comes may be another, in any.
  const bool only_by_look = std::all_of(
      missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(count), [&](std::size_t i) {
        return tracks_[i].look.is_known() && now - tracks_[i].seen() <= options_.forget_after;
      });
  const std::size_t candidates = find_candidates(vision, now, count, only_by_look);
  Assignment::Costs costs{};
  for (std::size_t m = 0; m < count; ++m)
    for (std::size_t c = 0; c < candidates; ++c)
      // Strangers keep the order from the left to the right.
      costs[m][c] = cost_of(missing[m], candidates_[c], now, only_by_look) +
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

}  // namespace dance
