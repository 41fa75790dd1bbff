// HandHolds: what is known of a dancer's palms by those of the partner, who dances here and now:
// palms that were together stay as they were to each other. How far that holds is told by how they
// have been to each other lately (transformers/partner/palm_weights.h), and whether it holds for
// these two at all by what then came.
//
// Units/frames: as transformers/partner/palm_guesses.h.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      without evidence nothing is pulled.
#pragma once

#include <array>

#include "core/motion/palm_pull.h"
#include "transformers/partner/palm_guesses.h"

namespace dance {

class HandHolds {
 public:
  void clear() { *this = HandHolds(); }
  // A pose has come: how the two stand to each other now, `step_s` after the last one.
  void follow(const Meeting& met, double step_s);
  // Tells a meeting what was learnt so far.
  void describe(Meeting& met) const;
  // A prediction whose moment has come: what it said alone `ahead_s` before, where palms are, and
  // where the partner is. `step_s`: since the last one.
  void learn(const Meeting& met, const Figure& predicted, float ahead_s, const Palms& came,
             const PartnerMoment& partner, double step_s);
  // What to do to a prediction.
  std::array<PalmPull, 2> pulls(const Meeting& met, const Figure& predicted, float ahead_s,
                                const PartnerMoment& partner) const;
  // How far the partner's hands say anything of this dancer's at all, 0 to 1.
  float trust() const;

 private:
  struct Errors {
    double offset = 0.0, plain = 0.0;  // square metres, seconds
    void add(double offset_m2, double plain_m2, double step_s) {
      offset += step_s * offset_m2;
      plain += step_s * plain_m2;
    }
    void forget(double keep) {
      offset *= keep;
      plain *= keep;
    }
    float proved(double prior_m2s) const {
      return static_cast<float>((plain - offset) / (plain + offset + prior_m2s));
    }
  };
  std::array<Errors, kPalmPairs> errors_, errors_now_;
  std::array<Eigen::Vector3f, kPalmPairs> usual_offset_m_;
  bool is_followed_ = false;
  Palms missed_m_{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  double missed_ahead_s_ = 0.0;
  double right_ = 0.0, all_ = 0.0;  // of what the partner's hands said
};

}  // namespace dance
