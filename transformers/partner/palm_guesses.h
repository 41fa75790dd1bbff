// PalmGuesses: what a partner's palms say of one palm of a dancer at a moment, before it is
// weighed (transformers/partner/palm_weights.h): guesses of where the palm is, and the signs that
// tell how far to believe them.
//
// Units/frames: metres in W; offsets of palms in a frame that turns with the line from one dancer's
//               hips to the other's.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      palms out of reach say nothing.
#pragma once

#include <array>

#include "transformers/partner/palm_weights.h"
#include "transformers/partner/partner_track.h"

namespace dance {

using Palms = std::array<Eigen::Vector3f, 2>;
constexpr std::size_t kPalmPairs = 4;  // own palm k / 2, the partner's k % 2

// What of a body has to do with the partner's.
struct Figure {
  Palms palms;
  Eigen::Vector3f p_WHips_m;
  Eigen::Vector3f facing_W;  // horizontal, unit
  std::array<Eigen::Quaternionf, 2> R_WForearm{Eigen::Quaternionf::Identity(),
                                               Eigen::Quaternionf::Identity()};
};

// How two dancers stood to each other at a moment that is known of both.
struct Meeting {
  // Beyond, palms have nothing to do with each other.
  static constexpr float kReach_m = 0.5f;

  std::array<Eigen::Vector3f, kPalmPairs> offset_m;  // of the own palm from the partner's
  Figure own;
  PartnerMoment partner;
  // As HandHolds had learnt by then.
  std::array<float, kPalmPairs> drift_m{};  // of the offset, beside its mean over some tenths
  std::array<float, kPalmPairs> proved_now{};
  std::array<float, kPalmPairs> proved{};  // -1: the prediction was right, 1: the offset
  Palms missed_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};  // by predictions of now
  float missed_ahead_s = 0.0f;                                       // made so long before

  static Meeting of(const Figure& own, const PartnerMoment& partner);
  // Where the own palm of a pair is, once the partner and the own hips are elsewhere.
  Eigen::Vector3f palm_at(std::size_t pair, const Eigen::Vector3f& hips,
                          const PartnerMoment& partner) const;
  // The same offset in a frame whose +Z is the line between the two.
  Eigen::Vector3f offset_in_line_m(std::size_t pair) const;
};

struct PalmGuesses {
  // By one palm of the partner; nothing said where the share is 0.
  struct ByPalm {
    std::array<Eigen::Vector3f, kPalmGuesses> guesses_m;  // differences to the prediction
    std::array<float, kPalmSigns> signs;
    float share = 0.0f;  // both add up to 1 at most, less at the end of the reach
  };
  // The weighted sum: by the partner, and by what predictions missed.
  struct Sum {
    Eigen::Vector3f by_partner = Eigen::Vector3f::Zero(), by_misses = Eigen::Vector3f::Zero();
  };

  std::array<ByPalm, 2> by;
  float near = 0.0f;  // 0: out of reach, 1: within it

  // Of the own palm `side` of a prediction that goes `ahead_s` beyond the meeting.
  static PalmGuesses of(const Meeting& met, const Figure& predicted, float ahead_s,
                        const PartnerMoment& partner, std::size_t side);
  Sum weighed(const PalmWeights& weights = kPalmWeights) const;
};

}  // namespace dance
