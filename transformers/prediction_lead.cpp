#include "transformers/prediction_lead.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/motion/saturated.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kOfHalf = 0.7f;
// Where half the moment is far ahead itself, twice its way tells no more than the way.
constexpr Duration kHalfUntil = Duration::ms(250), kWholeFrom = Duration::ms(450);
// What is new in a pose shows gradually, so that a picture is of a little further ahead than its
// moment.
constexpr Duration kShownLate = Duration::ms(40);
// A lead is as large as this at most: twice nonsense is not shown.
constexpr float kMost_rad = 0.4f, kMost_m = 0.15f;
// Feet that are ahead of themselves fly past the place where they will stand.
constexpr float kOfPlace = 0.5f, kOfLegs = 0.5f;

bool is_leg(std::size_t bone) { return bone >= index_of(Bone::kLeftUpperLeg); }

// As rotation_vector() for turns of less than a radian, and less than it for larger ones.
Vector3f turn_of(const Quaternionf& q) {
  const float s2 = q.vec().squaredNorm();
  const float size = 2.0f * (1.0f + s2 * (1.0f / 6.0f + s2 * (3.0f / 40.0f)));
  return q.vec() * (q.w() < 0.0f ? -size : size);
}

// exp_rotation() of at most kMost_rad.
Quaternionf small_turn(const Vector3f& v) {
  const float half2 = 0.25f * v.squaredNorm();
  Quaternionf q;
  q.w() = 1.0f - half2 * (0.5f - half2 / 24.0f);
  q.vec() = v * (0.5f - half2 / 12.0f);
  return q.normalized();
}

}  // namespace

PredictionLead::Shares PredictionLead::at(Duration ahead) const {
  const double s = (ahead + std::min(ahead, kShownLate)).as_seconds();
  // Between the horizons straight; from 1 at none, and no longer behind the last.
  double before_s = 0.0;
  float before = 1.0f, gain = gains_.back();
  for (std::size_t h = 0; h < kHorizons.size(); ++h) {
    const double here_s = kHorizons[h].as_seconds();
    if (s <= here_s) {
      gain =
          before + static_cast<float>((s - before_s) / (here_s - before_s)) * (gains_[h] - before);
      break;
    }
    before_s = here_s;
    before = gains_[h];
  }
  const double faded =
      smooth_step((ahead - kHalfUntil).as_seconds() / (kWholeFrom - kHalfUntil).as_seconds());
  const float of_half = strength_ * kOfHalf * static_cast<float>(1.0 - faded);
  gain = 1.0f + strength_ * (gain - 1.0f);
  return {gain * of_half, gain * (1.0f - of_half)};
}

void add_lead(const Pose& from, const Pose& half, const PredictionLead::Shares& shares,
              Pose& whole) {
  const float twice = 2.0f * shares.of_half, more = shares.of_whole - 1.0f;
  whole.p_WH_m +=
      kOfPlace *
      saturated(twice * (half.p_WH_m - from.p_WH_m) + more * (whole.p_WH_m - from.p_WH_m), kMost_m);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const Quaternionf back = from.R_PB[b].conjugate();
    const Vector3f lead = saturated(
        twice * turn_of(back * half.R_PB[b]) + more * turn_of(back * whole.R_PB[b]), kMost_rad);
    whole.R_PB[b] = whole.R_PB[b] * small_turn(is_leg(b) ? Vector3f(kOfLegs * lead) : lead);
  }
}

}  // namespace dance
