#include "producers/camera/people/limb_owner.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

struct LimbPoints {
  Landmark root, middle, end;
  std::array<Landmark, 3> beyond;  // move with the end
};
constexpr std::array<LimbPoints, LimbMotion::kLimbs> kLimbPoints{{
    {Landmark::kLeftShoulder,
     Landmark::kLeftElbow,
     Landmark::kLeftWrist,
     {Landmark::kLeftPinky, Landmark::kLeftIndex, Landmark::kLeftThumb}},
    {Landmark::kRightShoulder,
     Landmark::kRightElbow,
     Landmark::kRightWrist,
     {Landmark::kRightPinky, Landmark::kRightIndex, Landmark::kRightThumb}},
    {Landmark::kLeftHip,
     Landmark::kLeftKnee,
     Landmark::kLeftAnkle,
     {Landmark::kLeftHeel, Landmark::kLeftFootIndex, Landmark::kLeftFootIndex}},
    {Landmark::kRightHip,
     Landmark::kRightKnee,
     Landmark::kRightAnkle,
     {Landmark::kRightHeel, Landmark::kRightFootIndex, Landmark::kRightFootIndex}},
}};

constexpr float kVisible = 0.3f, kHidden = 0.05f;
constexpr float kLimbSpeedWeight = 0.4f, kLimbSpeedFades_s = 0.2f;
// A limb counts as longest for so long; and one picture shows it longer by so much at most.
constexpr float kShrinks_per_s = 0.02f, kMostGrowth = 0.05f;
// In lengths of the body's measure: limbs that are nearer to each other are one in the picture.
constexpr float kSameMean = 0.045f, kSameEach = 0.065f;
constexpr float kExpectedSd = 0.06f, kExcessSd = 0.1f, kMostTerm = 16.0f;
constexpr float kBehindTrunk = 4.0f;
constexpr float kClearly = 1.5f;
// A forearm or shank that is so much longer than ever ends in the other's hand or foot.
constexpr float kTooLong = 0.2f;

float measure_px(const SeenBody& body) { return std::max(1.0f, body.size_px()); }

std::array<Landmark, 2> ends_of(std::size_t limb) {
  return {kLimbPoints[limb].middle, kLimbPoints[limb].end};
}

bool is_seen(const SeenBody& body, std::size_t limb) {
  for (const Landmark l : ends_of(limb))
    if (!(body.visibility[index_of(l)] > kVisible)) return false;
  return true;
}

std::array<float, 2> lengths_of(const SeenBody& body, std::size_t limb) {
  const LimbPoints& points = kLimbPoints[limb];
  const Eigen::Vector2f middle = body.place_px(points.middle);
  const float measure = measure_px(body);
  return {(middle - body.place_px(points.root)).norm() / measure,
          (body.place_px(points.end) - middle).norm() / measure};
}

// Inside the quadrangle of shoulders and hips.
bool is_before_trunk(const SeenBody& body, const Eigen::Vector2f& p) {
  const std::array<Eigen::Vector2f, 4> corner{
      body.place_px(Landmark::kLeftShoulder), body.place_px(Landmark::kRightShoulder),
      body.place_px(Landmark::kRightHip), body.place_px(Landmark::kLeftHip)};
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2f side = corner[(i + 1) % 4] - corner[i], to = p - corner[i];
    (side.x() * to.y() - side.y() * to.x() > 0.0f ? left : right)++;
  }
  return left == 4 || right == 4;
}

void hide(SeenBody& body, std::size_t limb, bool only_end) {
  const LimbPoints& points = kLimbPoints[limb];
  const auto mark = [&body](Landmark l) {
    float& visibility = body.visibility[index_of(l)];
    visibility = std::min(visibility, kHidden);
  };
  if (!only_end) mark(points.middle);
  mark(points.end);
  for (const Landmark l : points.beyond) mark(l);
}

// What speaks against a limb's being this person's.
float cost_of(const LimbClaimant& own, const SeenBody& other, std::size_t limb, MonoTime now) {
  const SeenBody& body = *own.body;
  float cost = 0.0f;
  if (own.motion->is_known(limb, now)) {
    const LimbMotion::Ends expected = own.motion->expected(body, limb, now);
    const auto ends = ends_of(limb);
    for (std::size_t i = 0; i < 2; ++i) {
      const float off =
          (body.place_px(ends[i]) - expected.place_px[i]).norm() / (kExpectedSd * measure_px(body));
      cost += std::min(off * off, kMostTerm);
    }
    const auto longer = own.motion->excess(body, limb);
    const float excess = std::max(longer[0], longer[1]) / kExcessSd;
    cost += std::min(excess * excess, kMostTerm);
  }
  if (!own.is_in_front && is_before_trunk(other, body.place_px(kLimbPoints[limb].end)))
    cost += kBehindTrunk;
  return cost;
}

bool are_one(const SeenBody& a, std::size_t limb_a, const SeenBody& b, std::size_t limb_b) {
  const float measure = std::min(measure_px(a), measure_px(b));
  const auto ends_a = ends_of(limb_a), ends_b = ends_of(limb_b);
  float sum = 0.0f;
  for (std::size_t i = 0; i < 2; ++i) {
    const float apart = (a.place_px(ends_a[i]) - b.place_px(ends_b[i])).norm() / measure;
    if (apart > kSameEach) return false;
    sum += apart;
  }
  return 0.5f * sum < kSameMean;
}

// The end of a limb that reaches too far, to where the other's is.
bool ends_in(const LimbClaimant& own, const SeenBody& other, std::size_t limb, MonoTime now) {
  if (!own.motion->is_known(limb, now) || !(own.motion->excess(*own.body, limb)[1] > kTooLong))
    return false;
  const Eigen::Vector2f end = own.body->place_px(kLimbPoints[limb].end);
  const std::size_t kind = limb / 2 * 2;
  for (std::size_t theirs = kind; theirs < kind + 2; ++theirs)
    if ((other.place_px(kLimbPoints[theirs].end) - end).norm() < kSameEach * measure_px(other))
      return true;
  return false;
}

int resolve_pair(const LimbClaimant& a, const LimbClaimant& b, MonoTime now) {
  int hidden = 0;
  for (std::size_t limb = 0; limb < LimbMotion::kLimbs; ++limb)
    for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)})
      if (is_seen(*own->body, limb) && ends_in(*own, *other->body, limb, now)) {
        hide(*own->body, limb, true);
        ++hidden;
      }
  for (std::size_t mine = 0; mine < LimbMotion::kLimbs; ++mine) {
    const std::size_t kind = mine / 2 * 2;
    for (std::size_t theirs = kind; theirs < kind + 2; ++theirs) {
      if (!is_seen(*a.body, mine) || !is_seen(*b.body, theirs) ||
          !are_one(*a.body, mine, *b.body, theirs))
        continue;
      const float against_a = cost_of(a, *b.body, mine, now),
                  against_b = cost_of(b, *a.body, theirs, now);
      if (std::abs(against_a - against_b) < kClearly) continue;
      if (against_a > against_b)
        hide(*a.body, mine, false);
      else
        hide(*b.body, theirs, false);
      ++hidden;
    }
  }
  return hidden;
}

}  // namespace

void LimbMotion::update(const SeenBody& body, MonoTime now) {
  const float measure = measure_px(body);
  for (std::size_t i = 0; i < kLimbs; ++i) {
    if (!is_seen(body, i)) continue;
    Limb& limb = limbs_[i];
    const auto passed_s = static_cast<float>((now - limb.seen).as_seconds());
    const bool is_next = limb.pictures > 0 && passed_s > 0.0f && passed_s < 0.25f;
    const Eigen::Vector2f root = body.place_px(kLimbPoints[i].root);
    const auto ends = ends_of(i);
    for (std::size_t e = 0; e < 2; ++e) {
      const Eigen::Vector2f is = (body.place_px(ends[e]) - root) / measure;
      Eigen::Vector2f& speed = limb.speed.place_px[e];
      if (is_next)
        speed += kLimbSpeedWeight * ((is - limb.place.place_px[e]) / passed_s - speed);
      else
        speed.setZero();
      limb.place.place_px[e] = is;
    }
    const auto lengths = lengths_of(body, i);
    for (std::size_t e = 0; e < 2; ++e) {
      float& longest = limb.longest[e];
      if (is_next) longest *= 1.0f - kShrinks_per_s * passed_s;
      if (lengths[e] > longest)
        longest = limb.pictures < kKnown ? lengths[e]
                                         : std::min(lengths[e], longest * (1.0f + kMostGrowth));
    }
    limb.seen = now;
    limb.pictures = std::min(limb.pictures + 1, 1000);
  }
}

LimbMotion::Ends LimbMotion::expected(const SeenBody& body, std::size_t limb, MonoTime now) const {
  const Limb& known = limbs_[limb];
  const auto passed_s = static_cast<float>((now - known.seen).as_seconds());
  const float going_s = kLimbSpeedFades_s * (1.0f - std::exp(-passed_s / kLimbSpeedFades_s));
  Ends ends;
  for (std::size_t e = 0; e < 2; ++e)
    ends.place_px[e] =
        body.place_px(kLimbPoints[limb].root) +
        measure_px(body) * (known.place.place_px[e] + going_s * known.speed.place_px[e]);
  return ends;
}

std::array<float, 2> LimbMotion::excess(const SeenBody& body, std::size_t limb) const {
  const auto lengths = lengths_of(body, limb);
  std::array<float, 2> excess{};
  for (std::size_t e = 0; e < 2; ++e)
    if (limbs_[limb].longest[e] > 0.0f)
      excess[e] = std::max(0.0f, lengths[e] / limbs_[limb].longest[e] - 1.0f);
  return excess;
}

int resolve_limbs(std::span<const LimbClaimant> people, MonoTime now) {
  int hidden = 0;
  for (std::size_t i = 0; i < people.size(); ++i)
    for (std::size_t j = i + 1; j < people.size(); ++j)
      if (people[i].body && people[j].body) hidden += resolve_pair(people[i], people[j], now);
  return hidden;
}

}  // namespace dance
