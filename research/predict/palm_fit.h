// The weights of what a partner's palms say (transformers/partner/palm_weights.h), fitted to
// moments of recorded couples: the least mean error of palms, those in a hold counting threefold.
//
// Units/frames: metres in W.
// Ownership:    plain values.
// Threads:      none inside; the same moments give the same weights.
// Failure:      an Error where moments are too few.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "transformers/partner/palm_guesses.h"

namespace dance {

// One own palm at one horizon.
struct PalmMoment {
  PalmGuesses said;
  Eigen::Vector3f missing_m;  // from the plain prediction to where the palm was
  std::size_t horizon = 0;
  bool is_held = false;
};

// Two guesses alone are weighed by how the offset drifts and how far it is from the prediction.
constexpr bool is_palm_sign_weighed(PalmGuess guess, PalmSign sign) {
  return guess == PalmGuess::kOffset || guess == PalmGuess::kInHand ||
         (sign != PalmSign::kDrift && sign != PalmSign::kDisagree);
}

Result<PalmWeights> fit_palms(const std::vector<PalmMoment>& moments);
// As transformers/partner/palm_weights.h has it.
std::string palm_weights_text(const PalmWeights& weights);

}  // namespace dance
