#include "transformers/partner/palm_guesses.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

constexpr float kMostMissedAhead = 1.5f;
// Of two palms of the partner the nearer one counts.
constexpr float kNearer_m = 0.1f;
constexpr float kUsualAhead_s = 0.2f, kLeastAhead = 0.25f, kMostAhead = 1.75f;
constexpr float kLeastShare = 1e-6f;
// Hips that stand closer have no line between them.
constexpr float kLeastLine_m = 0.2f;
// The cosine and sine of 0.6 rad: no prediction is turned by more.
constexpr float kMostTurn_cos = 0.825f, kMostTurn_sin = 0.565f;

// A turn about the vertical, as cosine and sine.
struct Turn {
  float cosine = 1.0f, sine = 0.0f;
  Vector3f of(const Vector3f& v) const {
    return {cosine * v.x() + sine * v.z(), v.y(), cosine * v.z() - sine * v.x()};
  }
  // This one less another.
  Turn beside(const Turn& other) const {
    return {cosine * other.cosine + sine * other.sine, sine * other.cosine - cosine * other.sine};
  }
  Turn bounded() const {
    if (cosine > kMostTurn_cos) return *this;
    return {kMostTurn_cos, sine < 0.0f ? -kMostTurn_sin : kMostTurn_sin};
  }
};

Turn turn_between(const Vector3f& from, const Vector3f& to) {
  const float size = std::hypot(from.x(), from.z()) * std::hypot(to.x(), to.z());
  if (size < kLeastLine_m * kLeastLine_m) return {};
  // from x to about +Y.
  return {(from.x() * to.x() + from.z() * to.z()) / size,
          (from.z() * to.x() - from.x() * to.z()) / size};
}

// Learnt of palms in reach, and gone with it.
float in_reach(float apart_m) {
  return std::clamp(4.0f * (1.0f - apart_m / Meeting::kReach_m), 0.0f, 1.0f);
}

}  // namespace

Meeting Meeting::of(const Figure& own, const PartnerMoment& partner) {
  Meeting met;
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    met.offset_m[pair] = own.palms[pair / 2] - partner.p_WPalm_m[pair % 2];
  met.own = own;
  met.partner = partner;
  return met;
}

Vector3f Meeting::palm_at(std::size_t pair, const Vector3f& hips, const PartnerMoment& then) const {
  const Turn turn = turn_between(own.p_WHips_m - partner.p_WHips_m, hips - then.p_WHips_m);
  return then.p_WPalm_m[pair % 2] + turn.of(offset_m[pair]);
}

Vector3f Meeting::offset_in_line_m(std::size_t pair) const {
  const Turn turn = turn_between(own.p_WHips_m - partner.p_WHips_m, Vector3f::UnitZ());
  return turn.of(offset_m[pair]);
}

PalmGuesses PalmGuesses::of(const Meeting& met, const Figure& predicted, float ahead_s,
                            const PartnerMoment& partner, std::size_t side) {
  PalmGuesses said;
  const float a = met.offset_m[2 * side].norm(), b = met.offset_m[2 * side + 1].norm();
  const std::array<float, 2> near{in_reach(a), in_reach(b)};
  said.near = std::max(near[0], near[1]);
  if (!(said.near > 0.0f)) return said;
  const auto closeness = [](float apart_m, float in_reach) {
    const float x = apart_m / kNearer_m;
    return in_reach * std::exp(-0.5f * x * x) + 1e-9f;
  };
  const float sum = closeness(a, near[0]) + closeness(b, near[1]);
  const Vector3f& palm = predicted.palms[side];
  const Vector3f from_hips = palm - predicted.p_WHips_m;
  const Vector3f line = met.own.p_WHips_m - met.partner.p_WHips_m;
  const Turn with_line = turn_between(line, predicted.p_WHips_m - partner.p_WHips_m);
  const Turn as_partner = turn_between(met.partner.facing_W, partner.facing_W)
                              .beside(turn_between(met.own.facing_W, predicted.facing_W))
                              .bounded();
  const float ahead = std::clamp(ahead_s / kUsualAhead_s, kLeastAhead, kMostAhead);
  const float missed =
      met.missed_ahead_s > 0.0f ? std::min(ahead_s / met.missed_ahead_s, kMostMissedAhead) : 0.0f;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t pair = 2 * side + k;
    const float apart = k == 0 ? a : b;
    ByPalm& by = said.by[k];
    by.share = near[k] * closeness(apart, near[k]) / sum;
    if (by.share < kLeastShare) {
      by.share = 0.0f;
      continue;
    }
    const auto guess = [&](PalmGuess g) -> Vector3f& {
      return by.guesses_m[static_cast<std::size_t>(g)];
    };
    const Vector3f& offset = met.offset_m[pair];
    const Vector3f turned = partner.R_WHand[k] * (met.partner.R_WHand[k].conjugate() * offset);
    const Vector3f on_forearm =
        predicted.R_WForearm[side] * (met.own.R_WForearm[side].conjugate() * offset);
    guess(PalmGuess::kOffset) = partner.p_WPalm_m[k] + with_line.of(offset) - palm;
    guess(PalmGuess::kInHand) = partner.p_WPalm_m[k] + turned - palm;
    guess(PalmGuess::kTurned) = as_partner.of(from_hips) - from_hips;
    guess(PalmGuess::kMissed) = missed * met.missed_m[side];
    guess(PalmGuess::kHips) = partner.p_WHips_m + with_line.of(line) - predicted.p_WHips_m;
    guess(PalmGuess::kAlong) = partner.p_WHips_m + line - predicted.p_WHips_m;
    guess(PalmGuess::kOnForearm) = partner.p_WPalm_m[k] + on_forearm - palm;
    guess(PalmGuess::kAway) = with_line.of(offset);
    const float apart_then = guess(PalmGuess::kOffset).norm();
    by.signs = {1.0f,
                apart / 0.25f - 0.8f,
                met.drift_m[pair] / (met.drift_m[pair] + 0.05f) - 0.4f,
                apart_then / (apart_then + 0.1f * ahead) - 0.5f,
                met.proved[pair],
                ahead - 1.0f,
                met.proved_now[pair]};
  }
  return said;
}

PalmGuesses::Sum PalmGuesses::weighed(const PalmWeights& weights) const {
  Sum sum;
  for (const ByPalm& palm : by) {
    if (palm.share <= 0.0f) continue;
    for (std::size_t g = 0; g < kPalmGuesses; ++g) {
      float weight = 0.0f;
      for (std::size_t s = 0; s < kPalmSigns; ++s) weight += weights[g][s] * palm.signs[s];
      Vector3f& to =
          g == static_cast<std::size_t>(PalmGuess::kMissed) ? sum.by_misses : sum.by_partner;
      to += palm.share * weight * palm.guesses_m[g];
    }
  }
  return sum;
}

}  // namespace dance
