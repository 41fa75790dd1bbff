// predict: DancePredictor as the stage uses it: bounded in what a source that makes gaps may cost,
// and told whose body it predicts.
//
// Units/frames: as transformers/predict/dance_predictor.h.
// Ownership:    about four megabytes; never allocates after construction.
// Threads:      one owner; learner() is for another thread.
// Failure:      as transformers/predict/dance_predictor.h.
#pragma once

#include <memory>
#include <optional>

#include "core/base/token_bucket.h"
#include "transformers/predict/dance_predictor.h"
#include "transformers/predict/extrapolator.h"

namespace dance {

class DanceExtrapolator : public Extrapolator {
 public:
  // Null: the built-in model.
  explicit DanceExtrapolator(std::shared_ptr<const PredictModel> model = nullptr);

  void observe(const Pose& pose, MonoTime now) override;
  void predict(MonoTime moment, Pose& out) const override { predictor_.predict(moment, out); }
  void set_body(const Skeleton& skeleton) override;
  std::shared_ptr<Learner> learner() const override { return predictor_.personal(); }

  // What was worked through so far, in frames' worth.
  std::size_t rows_taken() const { return predictor_.rows_taken(); }

 private:
  std::shared_ptr<const PredictModel> model_;
  DancePredictor predictor_;
  std::optional<BoneLengths> body_;
  // By arrival: as many as a dance has, and a gap of two seconds at once.
  TokenBucket rows_allowed_{90.0, 120.0};
};

}  // namespace dance
