// PredictionGuard: no worse than what anyone can do. Beside the prediction it follows the errors of
// standing still, of going on, of going on and slowing down, and of halves between those; bone by
// bone, and for the hips' place by itself, what is shown leans to what has been right.
//
// Units/frames: ways as transformers/predict/blend/moment_predictions.h.
// Ownership:    plain value, 37 kB; never allocates.
// Threads:      none inside; one owner.
// Failure:      none; before anything is known it leans to the prediction.
#pragma once

#include <array>
#include <cstdint>

#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

class PredictionGuard {
 public:
  explicit PredictionGuard(const std::array<float, kRowGroups>& lever);
  void clear();
  // After a gap: how good predictions were lately is not known.
  void forget_lately();

  // A moment that is over: it went `way`.
  void learn(std::size_t horizon, const MomentPredictions& predictions, const BodyRow& way);
  // predictions.blended, or as far from it to plain predictions as those were better.
  void finish(std::size_t horizon, const MomentPredictions& predictions, BodyRow& way) const;

 private:
  static constexpr std::size_t kCandidates = 7;
  static constexpr std::size_t kStates = 2;  // the dancer stands, or moves
  struct alignas(64) Groups : std::array<float, kRowGroups> {};
  using ByCandidate = std::array<Groups, kCandidates>;
  // Errors, forgotten over time.
  struct Kept {
    float heard_moments = 0.0f;
    ByCandidate sum{};
  };
  struct Horizon {
    Kept lately, longer;
    // How much of the prediction, of going on and of going on damped is shown.
    std::array<Groups, 3> parts{};
  };
  void weigh(std::size_t horizon, std::size_t state);

  std::array<float, kRowGroups> lever_{};
  std::array<std::array<Horizon, kStates>, kHorizons> horizons_{};
};

}  // namespace dance
