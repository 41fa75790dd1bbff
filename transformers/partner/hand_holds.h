// HandHolds: what is known of a dancer's palms by those of the partner, who dances here and now:
// palms that were together stay as they were to each other. How far that holds is measured, pair by
// pair, against what the prediction alone said and what then came.
//
// Units/frames: metres in W; offsets of palms in a frame that turns with the line from one dancer's
//               hips to the other's.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      without evidence nothing is pulled.
// Source:       the share of the difference that turned out right is its regression on what was
//               missing, with a forgetting of seconds.
#pragma once

#include <array>

#include "core/motion/palm_pull.h"
#include "transformers/partner/partner_track.h"

namespace dance {

using Palms = std::array<Eigen::Vector3f, 2>;
constexpr std::size_t kPalmPairs = 4;  // own palm k / 2, the partner's k % 2

// How two dancers stood to each other at a moment that is known of both.
struct Meeting {
  std::array<Eigen::Vector3f, kPalmPairs> offset_m;  // of the own palm from the partner's
  Eigen::Vector3f p_WHips_m, p_WPartnerHips_m;

  static Meeting of(const Palms& own, const Eigen::Vector3f& hips, const PartnerMoment& partner);
  // Where the own palm of a pair is, once the partner and the own hips are elsewhere.
  Eigen::Vector3f palm_at(std::size_t pair, const Eigen::Vector3f& hips,
                          const PartnerMoment& partner) const;
};

class HandHolds {
 public:
  // Beyond, palms have nothing to do with each other.
  static constexpr float kReach_m = 0.5f;

  void clear() { *this = HandHolds(); }
  // A prediction whose moment has come: what it said alone of the palms and hips, where palms are,
  // and where the partner is. `step_s`: since the last one.
  void learn(const Meeting& met, const Palms& predicted, const Eigen::Vector3f& predicted_hips,
             const Palms& came, const PartnerMoment& partner, double step_s);
  // What to do to a prediction.
  std::array<PalmPull, 2> pulls(const Meeting& met, const Palms& predicted,
                                const Eigen::Vector3f& predicted_hips,
                                const PartnerMoment& partner) const;
  // How far the partner's hands say anything of this dancer's at all, 0 to 1.
  float trust() const;
  // The share of the difference that is right for a pair, which were so far apart.
  float share(std::size_t pair, float apart_m) const;

 private:
  struct Evidence {
    double right = 0.0, all = 0.0;
    double ratio(double prior, double prior_weight) const {
      return (right + prior * prior_weight) / (all + prior_weight);
    }
  };
  std::array<Evidence, kPalmPairs> pairs_;
  Evidence trust_;
};

}  // namespace dance
