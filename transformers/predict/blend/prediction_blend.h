// PredictionBlend: how much each prediction is worth for this dancer, joint by joint and horizon by
// horizon: a ridge regression that begins with the model's weights and follows how past moments
// went on. Moments count less the more their prediction was off, so that the mean error becomes
// small, not that of squares.
//
// Units/frames: predictions and ways as transformers/predict/blend/moment_predictions.h.
// Ownership:    its own sums; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none: predictions that are as good as nothing keep the model's weight.
#pragma once

#include <array>
#include <memory>

#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

class PredictionBlend {
 public:
  PredictionBlend();
  void clear();

  // What the weights begin with, and are drawn to.
  void set_prior(const KindWeights& prior);
  // A moment that is over: it went `way` after kHorizonFrames[horizon].
  void learn(std::size_t horizon, const MomentPredictions& predictions, const BodyRow& way);
  // Takes what was learned into the weights of one horizon.
  void solve(std::size_t horizon);
  void blend(std::size_t horizon, const MomentPredictions& predictions, BodyRow& way) const;

 private:
  static constexpr std::size_t kPairs = kPredictions * (kPredictions + 1) / 2;
  struct Horizon {
    alignas(64) std::array<float, kPairs * kRowGroups> pairs{};
    alignas(64) std::array<float, kPredictions * kRowGroups> targets{};
    alignas(64) std::array<float, kPredictions * kRowGroups> prior{};
    alignas(64) std::array<float, kPredictions * kRowGroups> weights{};
    std::array<float, kRowGroups> usual_error{};
    float heard = 0.0f;
  };
  std::unique_ptr<std::array<Horizon, kHorizons>> horizons_;
};

}  // namespace dance
