#include "transformers/partner/hand_holds.h"

#include <algorithm>
#include <cmath>

#include "transformers/partner/palm_weights.h"

namespace dance {

using Eigen::Vector3f;

namespace {

// Offsets drift beside their mean over so long.
constexpr double kUsualOffset_s = 0.15;
// Holds last for a beat or two: longer memories of a pair of palms left more errors.
constexpr double kProvedHalfLife_s = 0.35, kNowHalfLife_s = 0.12, kTrustHalfLife_s = 20.0;
constexpr double kProvedPrior_m2s = 1e-3, kNowPrior_m2s = 3.3e-4;
constexpr double kMissedOver_s = 0.05;
constexpr float kMostMissedAhead = 1.5f;
// As much as a third of a second of hands that are drawn by 4 cm.
constexpr double kTrustPrior_m2 = 10.0 * 0.04 * 0.04;
// What a dancer of another dance comes to by chance, and what is as right as of a true partner.
constexpr double kTrustBegins = 0.15, kTrustFull = 0.4;
// Of two palms of the partner the nearer one counts.
constexpr float kNearer_m = 0.1f;
constexpr float kUsualAhead_s = 0.2f, kLeastAhead = 0.25f, kMostAhead = 1.75f;
// Of what is known of a palm, so much draws it; the arm's usual errors tell the rest.
constexpr float kPullShare = 0.9f;
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

// From the line between the dancers to +Z.
Turn out_of_line(const Meeting& met) {
  return turn_between(met.own.p_WHips_m - met.partner.p_WHips_m, Vector3f::UnitZ());
}

// Learnt of palms in reach, and gone with it.
float in_reach(float apart_m) {
  return std::clamp(4.0f * (1.0f - apart_m / HandHolds::kReach_m), 0.0f, 1.0f);
}

double kept(double step_s, double half_life_s) { return std::exp2(-step_s / half_life_s); }

// Towards the plain prediction of a palm, what the partner tells, and what its own misses do.
struct Said {
  Vector3f by_partner = Vector3f::Zero(), by_misses = Vector3f::Zero();
  float near = 0.0f;
};

Said said_of(const Meeting& met, const Figure& predicted, float ahead_s,
             const PartnerMoment& partner, std::size_t side) {
  Said said;
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
  std::array<Vector3f, kPalmGuesses> guesses;
  const auto guess = [&](PalmGuess g) -> Vector3f& { return guesses[static_cast<std::size_t>(g)]; };
  guess(PalmGuess::kTurned) = as_partner.of(from_hips) - from_hips;
  guess(PalmGuess::kMissed) = missed * met.missed_m[side];
  guess(PalmGuess::kHips) = partner.p_WHips_m + with_line.of(line) - predicted.p_WHips_m;
  guess(PalmGuess::kAlong) = partner.p_WHips_m + line - predicted.p_WHips_m;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t pair = 2 * side + k;
    const float apart = k == 0 ? a : b;
    const float share = near[k] * closeness(apart, near[k]) / sum;
    if (share < 1e-6f) continue;
    const Vector3f& offset = met.offset_m[pair];
    const Vector3f turned = partner.R_WHand[k] * (met.partner.R_WHand[k].conjugate() * offset);
    guess(PalmGuess::kOffset) = partner.p_WPalm_m[k] + with_line.of(offset) - palm;
    guess(PalmGuess::kInHand) = partner.p_WPalm_m[k] + turned - palm;
    const Vector3f on_forearm =
        predicted.R_WForearm[side] * (met.own.R_WForearm[side].conjugate() * offset);
    guess(PalmGuess::kOnForearm) = partner.p_WPalm_m[k] + on_forearm - palm;
    guess(PalmGuess::kAway) = with_line.of(offset);
    const float apart_then = guess(PalmGuess::kOffset).norm();
    const std::array<float, kPalmSigns> signs{
        1.0f,
        apart / 0.25f - 0.8f,
        met.drift_m[pair] / (met.drift_m[pair] + 0.05f) - 0.4f,
        apart_then / (apart_then + 0.1f * ahead) - 0.5f,
        met.proved[pair],
        ahead - 1.0f,
        met.proved_now[pair]};
    for (std::size_t g = 0; g < kPalmGuesses; ++g) {
      float weight = 0.0f;
      for (std::size_t s = 0; s < kPalmSigns; ++s) weight += kPalmWeights[g][s] * signs[s];
      Vector3f& to =
          g == static_cast<std::size_t>(PalmGuess::kMissed) ? said.by_misses : said.by_partner;
      to += share * weight * guesses[g];
    }
  }
  return said;
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

void HandHolds::follow(const Meeting& met, double step_s) {
  const Turn turn = out_of_line(met);
  const auto share = static_cast<float>(1.0 - std::exp(-step_s / kUsualOffset_s));
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) {
    const Vector3f offset = turn.of(met.offset_m[pair]);
    if (!is_followed_) usual_offset_m_[pair] = offset;
    usual_offset_m_[pair] += share * (offset - usual_offset_m_[pair]);
  }
  is_followed_ = true;
}

void HandHolds::describe(Meeting& met) const {
  const Turn turn = out_of_line(met);
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) {
    if (is_followed_)
      met.drift_m[pair] = (turn.of(met.offset_m[pair]) - usual_offset_m_[pair]).norm();
    met.proved[pair] = errors_[pair].proved(kProvedPrior_m2s);
    met.proved_now[pair] = errors_now_[pair].proved(kNowPrior_m2s);
  }
  met.missed_m = missed_m_;
  met.missed_ahead_s = static_cast<float>(missed_ahead_s_);
}

float HandHolds::trust() const {
  const double ratio = right_ / (all_ + kTrustPrior_m2);
  return static_cast<float>(
      std::clamp((ratio - kTrustBegins) / (kTrustFull - kTrustBegins), 0.0, 1.0));
}

void HandHolds::learn(const Meeting& met, const Figure& predicted, float ahead_s, const Palms& came,
                      const PartnerMoment& partner, double step_s) {
  const double proved_keep = kept(step_s, kProvedHalfLife_s);
  const double now_keep = kept(step_s, kNowHalfLife_s);
  const double trust_keep = kept(step_s, kTrustHalfLife_s);
  right_ *= trust_keep;
  all_ *= trust_keep;
  const double newer = 1.0 - std::exp(-step_s / kMissedOver_s);
  missed_ahead_s_ += newer * (static_cast<double>(ahead_s) - missed_ahead_s_);
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3f missing = came[side] - predicted.palms[side];
    if (!missing.allFinite()) continue;
    missed_m_[side] += static_cast<float>(newer) * (missing - missed_m_[side]);
    for (std::size_t pair = 2 * side; pair < 2 * side + 2; ++pair) {
      errors_[pair].forget(proved_keep);
      errors_now_[pair].forget(now_keep);
      if (!(met.offset_m[pair].norm() < kReach_m)) continue;
      const Vector3f wrong = met.palm_at(pair, predicted.p_WHips_m, partner) - came[side];
      if (!wrong.allFinite()) continue;
      const auto offset_m2 = static_cast<double>(wrong.squaredNorm());
      const auto plain_m2 = static_cast<double>(missing.squaredNorm());
      errors_[pair].add(offset_m2, plain_m2, step_s);
      errors_now_[pair].add(offset_m2, plain_m2, step_s);
    }
    const Vector3f said = said_of(met, predicted, ahead_s, partner, side).by_partner;
    if (!said.allFinite()) continue;
    right_ += static_cast<double>(said.dot(missing));
    all_ += static_cast<double>(said.squaredNorm());
  }
}

std::array<PalmPull, 2> HandHolds::pulls(const Meeting& met, const Figure& predicted, float ahead_s,
                                         const PartnerMoment& partner) const {
  std::array<PalmPull, 2> pulls;
  const float trusted = trust();
  if (trusted <= 0.0f) return pulls;
  for (std::size_t side = 0; side < 2; ++side) {
    const Said said = said_of(met, predicted, ahead_s, partner, side);
    pulls[side].share = kPullShare * said.near * trusted;
    if (pulls[side].share <= 0.0f) continue;
    pulls[side].shift_W_m = (said.by_partner + said.by_misses) / (kPullShare * said.near);
  }
  return pulls;
}

}  // namespace dance
