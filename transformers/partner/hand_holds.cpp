#include "transformers/partner/hand_holds.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

// Offsets drift beside their mean over so long.
constexpr double kUsualOffset_s = 0.15;
// Holds last for a beat or two: longer memories of a pair of palms left more errors.
constexpr double kProvedHalfLife_s = 0.35, kNowHalfLife_s = 0.12, kTrustHalfLife_s = 20.0;
constexpr double kProvedPrior_m2s = 1e-3, kNowPrior_m2s = 3.3e-4;
constexpr double kMissedOver_s = 0.05;
// As much as a third of a second of hands that are drawn by 4 cm.
constexpr double kTrustPrior_m2 = 10.0 * 0.04 * 0.04;
// What a dancer of another dance comes to by chance, and what is as right as of a true partner.
constexpr double kTrustBegins = 0.15, kTrustFull = 0.4;
// Of what is known of a palm, so much draws it; the arm's usual errors tell the rest.
constexpr float kPullShare = 0.9f;

double kept(double step_s, double half_life_s) { return std::exp2(-step_s / half_life_s); }

}  // namespace

void HandHolds::follow(const Meeting& met, double step_s) {
  const auto share = static_cast<float>(1.0 - std::exp(-step_s / kUsualOffset_s));
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) {
    const Vector3f offset = met.offset_in_line_m(pair);
    if (!is_followed_) usual_offset_m_[pair] = offset;
    usual_offset_m_[pair] += share * (offset - usual_offset_m_[pair]);
  }
  is_followed_ = true;
}

void HandHolds::describe(Meeting& met) const {
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) {
    if (is_followed_)
      met.drift_m[pair] = (met.offset_in_line_m(pair) - usual_offset_m_[pair]).norm();
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
      if (!(met.offset_m[pair].norm() < Meeting::kReach_m)) continue;
      const Vector3f wrong = met.palm_at(pair, predicted.p_WHips_m, partner) - came[side];
      if (!wrong.allFinite()) continue;
      const auto offset_m2 = static_cast<double>(wrong.squaredNorm());
      const auto plain_m2 = static_cast<double>(missing.squaredNorm());
      errors_[pair].add(offset_m2, plain_m2, step_s);
      errors_now_[pair].add(offset_m2, plain_m2, step_s);
    }
    const Vector3f said =
        PalmGuesses::of(met, predicted, ahead_s, partner, side).weighed().by_partner;
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
    const PalmGuesses said = PalmGuesses::of(met, predicted, ahead_s, partner, side);
    pulls[side].share = kPullShare * said.near * trusted;
    if (pulls[side].share <= 0.0f) continue;
    const PalmGuesses::Sum sum = said.weighed();
    pulls[side].shift_W_m = (sum.by_partner + sum.by_misses) / (kPullShare * said.near);
  }
  return pulls;
}

}  // namespace dance
