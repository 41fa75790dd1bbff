// PredictionProof: how much of the personal model's correction to take, joint by joint: as much as
// would have been right lately.
//
// Units/frames: ways as transformers/predict/blend/moment_predictions.h.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none; before anything is known, nothing of the personal model.
#pragma once

#include <array>
#include <cstdint>

#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

class PredictionProof {
 public:
  void clear();

  // A moment that is over: it went `way`.
  void learn(std::size_t horizon, const MomentPredictions& predictions, const BodyRow& way);
  // Adds what is proved of predictions.personal.
  void add_personal(std::size_t horizon, const MomentPredictions& predictions, BodyRow& way) const;
  // How far it is proved that the personal model knows this dancer: 0 to 1, by the bones that are
  // seen.
  float proved(std::size_t horizon, std::uint32_t presence) const;
  // Forgets what the personal model has proved: a new one is there.
  void discount_personal();

 private:
  struct Horizon {
    // Share s of a correction c to a prediction p that is least wrong: sum (y - p) c / sum c².
    alignas(64) std::array<float, kRowGroups> right{}, size{};
    alignas(64) std::array<float, kRowGroups> share{};
  };
  std::array<Horizon, kHorizons> horizons_{};
};

}  // namespace dance
