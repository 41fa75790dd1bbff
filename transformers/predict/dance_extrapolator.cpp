#include "transformers/predict/dance_extrapolator.h"

namespace dance {
namespace {

// A body that is measured again differs by less; this is another dancer's.
constexpr float kOtherBody_m = 0.03f;

}  // namespace

DanceExtrapolator::DanceExtrapolator(std::shared_ptr<const PredictModel> model)
    : model_(model ? std::move(model) : built_in_predict_model()), predictor_(model_) {}

void DanceExtrapolator::set_body(const Skeleton& skeleton) {
  const BoneLengths lengths = bone_lengths(skeleton);
  if (body_ && !is_alike(*body_, lengths, kOtherBody_m)) predictor_.forget_dancer();
  body_ = lengths;
  predictor_.set_acquaintance(model_->knows(skeleton) ? Acquaintance::kDancer
                                                      : Acquaintance::kOthers);
}

void DanceExtrapolator::observe(const Pose& pose, MonoTime now) {
  // A gap is filled with rows, each of which costs as much as a pose: a source that makes gaps all
  // the time begins anew instead.
  if (!rows_allowed_.take(predictor_.rows_until(pose.capture_time), now)) predictor_.lose_thread();
  predictor_.observe(pose);
}

}  // namespace dance
