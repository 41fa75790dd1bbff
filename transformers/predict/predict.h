// predict: shows the dancer as they are now, or nearer to it than what has arrived: takes the way's
// delay back by predicting (transformers/predict/dance_predictor.h). What has arrived is shown as
// it is; corrections go in without a pop, and guessed feet stand where they stand.
//
// Units/frames: capture times and `now` are of one clock, as the tunnel maps them. `lead` is the
//               part of the delay that is taken back, 0 to 1.5; `most` is the furthest that is
//               predicted.
// Ownership:    about four megabytes and the last 12 s of poses; never allocates after
//               construction.
// Threads:      one owner; learner() is for another thread.
// Failure:      a pose that is not newer is refused and counted; a source that jumps or changes its
//               clock starts anew and is counted. Poses whose clock is not this house's are shown
//               as they come, without a lead.
#pragma once

#include <memory>
#include <optional>

#include "core/base/token_bucket.h"
#include "core/motion/finish.h"
#include "core/pose/history.h"
#include "transformers/playout/least_transit.h"
#include "transformers/predict/dance_predictor.h"
#include "transformers/transformer.h"

namespace dance {

struct PredictOptions {
  double lead = 1.0;
  Duration most = Duration::ms(300);
  std::shared_ptr<const PredictModel> model;  // null: the built-in one
};

class Predict : public Transformer {
 public:
  explicit Predict(const PredictOptions& options = {});

  void observe(const Pose& pose, MonoTime now) override;
  bool sample(MonoTime now, Pose& out) override;
  MonoTime moment(MonoTime now) override;
  bool sample_at(MonoTime moment, MonoTime now, Pose& out) override;
  void set_body(const Skeleton& skeleton) override;
  std::shared_ptr<Learner> learner() override { return predictor_.personal(); }

  // What was worked through so far, in frames' worth.
  std::size_t rows_taken() const { return predictor_.rows_taken(); }

 private:
  void note_transit(Duration transit, MonoTime now);
  bool pose_at(MonoTime moment, Duration most, Pose& out) const;
  void forget();

  PredictOptions options_;
  DancePredictor predictor_;
  std::optional<BoneLengths> body_;
  PoseHistory history_;
  Finish finish_;

  LeastTransit least_transit_;
  Duration transit_;  // followed slowly

  // By arrival: as many as a dance has, and a lapse of two seconds at once.
  TokenBucket rows_allowed_{90.0, 120.0};

  MonoTime shown_, shown_at_;
  bool has_shown_ = false;
};

}  // namespace dance
