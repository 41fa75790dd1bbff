#include "transformers/partner/hand_holds.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

// What the palms of couples in salsa were worth 200 ms ahead, by how far apart they were: 0.55 side
// by side, 0.3 at 25 cm.
constexpr float kUsualShare = 0.56f, kUsualApart_m = 0.3f;
// Evidence is square metres of difference, a moment each; halved in this time. Holds last for a
// beat or two: longer memories of a pair of palms left more errors, shorter ones followed noise.
constexpr double kPairHalfLife_s = 0.5, kTrustHalfLife_s = 20.0;
// As much as half a second of prediction errors of 8 cm: before that the usual share counts.
constexpr double kPairPrior_m2 = 15.0 * 0.08 * 0.08;
constexpr double kTrustPrior_m2 = 30.0 * 0.04 * 0.04;
// Hips that stand closer have no line between them.
constexpr float kLeastLine_m = 0.2f;

float usual_share(float apart_m) {
  const float x = apart_m / kUsualApart_m;
  // To 0 at kReach_m, without a corner.
  const float near = std::max(0.0f, 1.0f - apart_m / HandHolds::kReach_m);
  return kUsualShare * std::exp(-x * x) * std::min(1.0f, 2.0f * near);
}

// The turn about the vertical from one line to another, as cosine and sine.
struct Turn {
  float cosine = 1.0f, sine = 0.0f;
  Vector3f of(const Vector3f& v) const {
    return {cosine * v.x() + sine * v.z(), v.y(), cosine * v.z() - sine * v.x()};
  }
};

Turn turn_between(const Vector3f& from, const Vector3f& to) {
  const float size = std::hypot(from.x(), from.z()) * std::hypot(to.x(), to.z());
  if (size < kLeastLine_m * kLeastLine_m) return {};
  // from x to about +Y.
  return {(from.x() * to.x() + from.z() * to.z()) / size,
          (from.z() * to.x() - from.x() * to.z()) / size};
}

}  // namespace

Meeting Meeting::of(const Palms& own, const Vector3f& hips, const PartnerMoment& partner) {
  Meeting met;
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    met.offset_m[pair] = own[pair / 2] - partner.p_WPalm_m[pair % 2];
  met.p_WHips_m = hips;
  met.p_WPartnerHips_m = partner.p_WHips_m;
  return met;
}

Vector3f Meeting::palm_at(std::size_t pair, const Vector3f& hips,
                          const PartnerMoment& partner) const {
  const Turn turn = turn_between(p_WHips_m - p_WPartnerHips_m, hips - partner.p_WHips_m);
  return partner.p_WPalm_m[pair % 2] + turn.of(offset_m[pair]);
}

float HandHolds::trust() const {
  return static_cast<float>(std::clamp(trust_.ratio(0.0, kTrustPrior_m2), 0.0, 1.0));
}

float HandHolds::share(std::size_t pair, float apart_m) const {
  const double prior = static_cast<double>(trust() * usual_share(apart_m));
  const double ratio = std::clamp(pairs_[pair].ratio(prior, kPairPrior_m2), 0.0, 1.0);
  // Learnt of palms in reach, and gone with it.
  const float near = std::clamp(4.0f * (1.0f - apart_m / kReach_m), 0.0f, 1.0f);
  return near * static_cast<float>(ratio);
}

void HandHolds::learn(const Meeting& met, const Palms& predicted, const Vector3f& predicted_hips,
                      const Palms& came, const PartnerMoment& partner, double step_s) {
  const double pair_keep = std::exp2(-step_s / kPairHalfLife_s);
  const double trust_keep = std::exp2(-step_s / kTrustHalfLife_s);
  trust_.right *= trust_keep;
  trust_.all *= trust_keep;
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair) {
    Evidence& evidence = pairs_[pair];
    evidence.right *= pair_keep;
    evidence.all *= pair_keep;
    const float apart = met.offset_m[pair].norm();
    if (!(apart < kReach_m)) continue;
    const Vector3f said = met.palm_at(pair, predicted_hips, partner) - predicted[pair / 2];
    const Vector3f missing = came[pair / 2] - predicted[pair / 2];
    const double right = static_cast<double>(said.dot(missing));
    const double all = static_cast<double>(said.squaredNorm());
    if (!std::isfinite(right) || !std::isfinite(all)) continue;
    const auto usual = static_cast<double>(usual_share(apart));
    evidence.right += right;
    evidence.all += all;
    trust_.right += usual * right;
    trust_.all += usual * usual * all;
  }
}

std::array<PalmPull, 2> HandHolds::pulls(const Meeting& met, const Palms& predicted,
                                         const Vector3f& predicted_hips,
                                         const PartnerMoment& partner) const {
  std::array<PalmPull, 2> pulls;
  for (std::size_t side = 0; side < 2; ++side) {
    float sum = 0.0f, free = 1.0f;
    Vector3f shift = Vector3f::Zero();
    for (std::size_t pair = 2 * side; pair < 2 * side + 2; ++pair) {
      const float part = share(pair, met.offset_m[pair].norm());
      if (part <= 0.0f) continue;
      // A pair that is surer counts more than its share.
      const float weight = part / (1.02f - part);
      shift += weight * (met.palm_at(pair, predicted_hips, partner) - predicted[side]);
      sum += weight;
      free *= 1.0f - part;
    }
    if (sum <= 0.0f) continue;
    pulls[side].shift_W_m = shift / sum;
    pulls[side].share = 1.0f - free;
  }
  return pulls;
}

}  // namespace dance
