#include "transformers/partner/couple_finder.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Vector3f;

namespace {

// The scores are means over some seconds: a turn under the arm ends no couple.
constexpr double kCoupleOver_s = 1.5;
constexpr float kCoupleBegins = 0.35f, kCoupleEnds = 0.15f;
// Another one has to be so much more of a partner.
constexpr float kBetterPartner = 1.5f;
// Couples in salsa dance at 0.5 to 1 m; beyond twice that nobody is together.
constexpr float kCoupleNear_m = 1.0f, kCoupleFar_m = 2.0f;
constexpr float kHandsNear_m = 0.25f, kHandsFar_m = 0.6f;

// 1 up to `near`, 0 from `far` on.
float ramp(float x, float near, float far) {
  return std::clamp((far - x) / (far - near), 0.0f, 1.0f);
}

}  // namespace

float CoupleFinder::likeness(const Palms& own, const Vector3f& hips, const Vector3f& facing,
                             const PartnerMoment& other) {
  Vector3f apart = other.p_WHips_m - hips;
  apart.y() = 0.0f;
  const float distance = apart.norm();
  if (!(distance < kCoupleFar_m)) return 0.0f;
  float hands_m = 1e3f;
  for (std::size_t pair = 0; pair < kPalmPairs; ++pair)
    hands_m = std::min(hands_m, (own[pair / 2] - other.p_WPalm_m[pair % 2]).norm());
  const float hands = ramp(hands_m, kHandsNear_m, kHandsFar_m);
  // Each looks the other's way.
  const Vector3f towards = distance > 1e-3f ? Vector3f(apart / distance) : facing;
  const float faces = 0.5f * (facing.dot(towards) - other.facing_W.dot(towards));
  return ramp(distance, kCoupleNear_m, kCoupleFar_m) *
         std::max(hands, 0.7f * std::clamp(faces, 0.0f, 1.0f));
}

std::optional<std::size_t> CoupleFinder::update(const PartnerTracks& dancers, const Stance& stance,
                                                double step_s) {
  const auto share =
      static_cast<float>(1.0 - std::exp(-std::clamp(step_s, 0.0, 1.0) / kCoupleOver_s));
  std::size_t best = 0;
  for (std::size_t place = 0; place < dancers.size(); ++place) {
    const PartnerTrack& track = dancers[place];
    if (generations_[place] != dancers.generation(place)) {
      generations_[place] = dancers.generation(place);
      scores_[place] = 0.0f;
      if (partner_ == place) partner_ = std::nullopt;
    }
    const bool is_here = !track.is_empty() && track.clock_id() == stance.clock_id &&
                         stance.now - track.newest().time < kUnseen;
    const auto other = is_here ? track.at_latest(stance.then) : std::nullopt;
    const float is = other ? likeness(stance.palms, stance.hips, stance.facing, *other) : 0.0f;
    scores_[place] += share * (is - scores_[place]);
    if (scores_[place] > scores_[best]) best = place;
  }
  if (partner_ && (*partner_ >= dancers.size() || scores_[*partner_] < kCoupleEnds))
    partner_ = std::nullopt;
  if (dancers.size() == 0) return partner_;
  if (partner_ ? scores_[best] > kBetterPartner * scores_[*partner_]
               : scores_[best] > kCoupleBegins)
    partner_ = best;
  return partner_;
}

}  // namespace dance
