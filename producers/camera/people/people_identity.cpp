// Whose body it is, by the colours of the clothes: the part of PeopleTracker that judges it.
#include <algorithm>
#include <utility>

#include "producers/camera/people/people_tracker.h"

namespace dance {
namespace {

// Farther apart than this the colours of two people are their own.
constexpr float kNear_sides = 0.06f, kApart_sides = 0.15f;
constexpr float kMostEvidence = 4.0f, kLeastSum = -1.0f, kExchange = 4.0f;
constexpr float kDoubtful = 3.0f, kMostDoubt = 4.0f, kRefused = 8.0f;
constexpr Duration kCompany = Duration::s(3);
// A body is another's who goes on there, where it is nearer than by this share, and by so much of a
// body's measure.
constexpr float kOnCourse = 0.65f, kLeastGain = 0.06f;

}  // namespace

float PeopleTracker::distance(std::size_t a, std::size_t b, MonoTime now) const {
  const auto middle = [&](std::size_t i) {
    return found_[i].is_found ? centre_of(found_[i].body.next_region())
                              : tracks_[i].expected_px(now);
  };
  const auto side = [&](std::size_t i) {
    return found_[i].is_found ? found_[i].body.next_region().side_px : tracks_[i].region().side_px;
  };
  return (middle(a) - middle(b)).norm() / std::max(1.0f, std::min(side(a), side(b)));
}

// A region beside two bodies may show the other in one picture. Nobody jumps into another's
// posture: the body is that person's who was about to be there, and the one whose region it was is
// looked for.
void PeopleTracker::reassign_bodies(MonoTime now, const Reads& reads) {
  for (std::size_t a = 0; a < options_.people; ++a)
    for (std::size_t b = 0; b < options_.people; ++b) {
      if (a == b || !found_[a].is_found || !reads[b]) continue;
      const SeenBody& body = found_[a].body;
      auto own = tracks_[a].off_course(body, now), others = tracks_[b].off_course(body, now);
      if (!own || !others) continue;
      if (found_[b].is_found) {
        const auto back = tracks_[b].off_course(found_[b].body, now),
                   to_a = tracks_[a].off_course(found_[b].body, now);
        if (!back || !to_a) continue;
        *own += *back;
        *others += *to_a;
      }
      if (*others > kOnCourse * *own || *own - *others < kLeastGain) continue;
      ++counters_.reassigned;
      std::swap(found_[a], found_[b]);
      for (const std::size_t i : {a, b})
        if (!found_[i].is_found) tracks_[i].lose();
    }
}

// How much better the picture's colours fit if the two were taken for each other.
float PeopleTracker::evidence_of_exchange(std::size_t a, std::size_t b, const Looks& looks) const {
  float evidence = 0.0f;
  if (!tracks_[a].look.differs_from(tracks_[b].look)) return evidence;
  for (const auto& [is, other] : {std::pair(a, b), std::pair(b, a)}) {
    if (!found_[is].is_found) continue;
    const auto own = tracks_[is].look.distance(looks[is]);
    const auto theirs = tracks_[other].look.distance(looks[is]);
    if (own && theirs) evidence += *own - *theirs;
  }
  return std::clamp(evidence, -kMostEvidence, kMostEvidence);
}

void PeopleTracker::exchange(std::size_t a, std::size_t b) {
  ++counters_.exchanged;
  std::swap(found_[a], found_[b]);
  std::swap(tracks_[a], tracks_[b]);
  std::swap(tracks_[a].look, tracks_[b].look);
  std::swap(lowest_px_[a], lowest_px_[b]);
  std::swap(is_left_out_[a], is_left_out_[b]);
  doubt_[a] = doubt_[b] = 0.0f;
  for (std::size_t i = 0; i < kMostDancers; ++i)
    evidence_[a][i] = evidence_[b][i] = evidence_[i][a] = evidence_[i][b] = 0.0f;
  limbs_[a].reset();
  limbs_[b].reset();
  for (const std::size_t i : {a, b})
    if (found_[i].is_found) found_[i].is_new = true;
}

void PeopleTracker::judge_identities(PeopleVision& vision, MonoTime now) {
  Looks looks;
  std::array<bool, kMostDancers> may_learn{};
  for (std::size_t i = 0; i < options_.people; ++i) {
    may_learn[i] = found_[i].is_found;
    if (found_[i].is_found) looks[i] = look_of(found_[i].body, vision);
  }
  for (std::size_t a = 0; a < options_.people; ++a)
    for (std::size_t b = a + 1; b < options_.people; ++b) {
      if (!found_[a].is_found && !found_[b].is_found) continue;
      const auto is_about = [&](std::size_t i) {
        return found_[i].is_found ||
               (tracks_[i].was_ever_seen() && now - tracks_[i].seen() < kCompany);
      };
      if (!is_about(a) || !is_about(b)) continue;
      const float apart = distance(a, b, now);
      if (apart < kApart_sides) may_learn[a] = may_learn[b] = false;
      if (!tracks_[a].look.is_known() || !tracks_[b].look.is_known()) continue;
      const bool are_both = present(a) && present(b);
      const float weight =
          are_both ? std::clamp((apart - kNear_sides) / (kApart_sides - kNear_sides), 0.0f, 1.0f)
                   : 1.0f;
      float& evidence = evidence_[a][b];
      evidence = std::max(evidence + weight * evidence_of_exchange(a, b, looks), kLeastSum);
      if (evidence > 0.0f) may_learn[a] = may_learn[b] = false;
      if (evidence < kExchange) continue;
      exchange(a, b);
      std::swap(looks[a], looks[b]);
      evidence = 0.0f;
      may_learn[a] = may_learn[b] = false;
    }
  for (std::size_t i = 0; i < options_.people; ++i) {
    if (!found_[i].is_found || is_refused(i, looks[i])) continue;
    if (may_learn[i]) tracks_[i].look.learn(looks[i]);
  }
}

// A region that has come to somebody else, who is before this person, shows other colours.
bool PeopleTracker::is_refused(std::size_t person, const PersonLook& look) {
  PersonTrack& track = tracks_[person];
  const auto off = track.look.is_known() ? track.look.distance(look) : std::nullopt;
  if (!off) return false;
  float& doubt = doubt_[person];
  doubt = std::max(0.0f, doubt + std::clamp(*off - kDoubtful, -kMostDoubt, kMostDoubt));
  if (doubt < kRefused) return *off > kDoubtful;
  doubt = 0.0f;
  found_[person].is_found = false;
  track.lose();
  return true;
}

}  // namespace dance
