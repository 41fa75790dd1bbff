#include "transformers/predict/prediction_meter.h"

#include <algorithm>

namespace dance {
namespace {

constexpr double kForget = 0.98;  // per prediction of one distance: some twenty seconds
constexpr double kEnoughPredictions = 8.0;
constexpr Duration kStep = Duration::ms(17);
// No prediction is worth more than this much beyond what is wanted.
constexpr double kMostLead = 2.0;

double between(double a, double b, double fraction) { return a + (b - a) * fraction; }

}  // namespace

void PredictionMeter::clear() {
  for (Prediction& prediction : predictions_) prediction.waits = false;
  scores_ = {};
}

void PredictionMeter::body_positions(const Pose& pose,
                                     std::array<Eigen::Vector3f, kBoneCount>& p_HB_m) const {
  Pose still = pose;
  still.R_PB[0] = Eigen::Quaternionf::Identity();
  still.p_WH_m.setZero();
  BodyFrames frames;
  forward_kinematics(skeleton_, still, frames);
  p_HB_m = frames.p_WB_m;
}

void PredictionMeter::note(const Pose& pose, MonoTime moment) {
  Prediction& prediction = predictions_[write_++ % predictions_.size()];
  prediction.moment = moment;
  prediction.horizon = next_;
  prediction.waits = true;
  body_positions(pose, prediction.p_HB_m);
  next_ = (next_ + 1) % kHorizons.size();
}

void PredictionMeter::learn(const PoseHistory& history) {
  if (history.size() < 4) return;
  for (Prediction& prediction : predictions_) {
    if (!prediction.waits || prediction.moment + kStep > history.newest().capture_time) continue;
    prediction.waits = false;
    const auto truth = history.at(prediction.moment);
    const auto before = history.at(prediction.moment - kStep),
               after = history.at(prediction.moment + kStep);
    // What fell into a gap of the line has no truth to be compared with.
    if (truth->how == PoseHistory::How::kHeldFirst || truth->how == PoseHistory::How::kHeldLast)
      continue;
    std::array<Eigen::Vector3f, kBoneCount> is, was, will;
    body_positions(truth->pose, is);
    body_positions(before->pose, was);
    body_positions(after->pose, will);
    double error_m = 0.0, against = 0.0, speed2 = 0.0;
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const Eigen::Vector3f off = prediction.p_HB_m[b] - is[b];
      const Eigen::Vector3f velocity =
          (will[b] - was[b]) / static_cast<float>(2.0 * kStep.as_seconds());
      error_m += static_cast<double>(off.norm());
      against -= static_cast<double>(off.dot(velocity));
      speed2 += static_cast<double>(velocity.squaredNorm());
    }
    Score& score = scores_[prediction.horizon];
    score.weight = kForget * score.weight + 1.0;
    score.error_m = kForget * score.error_m + error_m / (kBoneCount - 1);
    score.against = kForget * score.against + against;
    score.speed2 = kForget * score.speed2 + speed2;
  }
}

bool PredictionMeter::is_known() const {
  return std::all_of(scores_.begin(), scores_.end(),
                     [](const Score& score) { return score.weight >= kEnoughPredictions; });
}

double PredictionMeter::error_m(Duration horizon) const {
  double before_s = 0.0, before_m = 0.0;
  for (std::size_t i = 0; i < kHorizons.size(); ++i) {
    const double here_s = kHorizons[i].as_seconds();
    const double here_m = scores_[i].weight > 0.0 ? scores_[i].error_m / scores_[i].weight : 0.0;
    if (horizon <= kHorizons[i])
      return between(before_m, here_m, (horizon.as_seconds() - before_s) / (here_s - before_s));
    before_s = here_s;
    before_m = here_m;
  }
  return before_m;
}

Duration PredictionMeter::reach(double most_error_m) const {
  Duration reach;
  double before_m = 0.0;
  for (std::size_t i = 0; i < kHorizons.size(); ++i) {
    const double here_m = error_m(kHorizons[i]);
    if (here_m > most_error_m) {
      const double fraction = (most_error_m - before_m) / (here_m - before_m);
      return reach +
             Duration::seconds(std::max(0.0, fraction) * (kHorizons[i] - reach).as_seconds());
    }
    reach = kHorizons[i];
    before_m = here_m;
  }
  return reach;
}

double PredictionMeter::lag_s(std::size_t horizon) const {
  const Score& score = scores_[horizon];
  if (score.weight < kEnoughPredictions || score.speed2 <= 1e-9) return 0.0;
  return std::clamp(score.against / score.speed2, 0.0, 0.9 * kHorizons[horizon].as_seconds());
}

Duration PredictionMeter::lead(Duration ahead) const {
  // Predicting h ahead shows h - lag(h): the h that shows `ahead`.
  const double wanted_s = ahead.as_seconds();
  double before_h_s = 0.0, before_shown_s = 0.0;
  for (std::size_t i = 0; i < kHorizons.size(); ++i) {
    const double h_s = kHorizons[i].as_seconds();
    const double shown_s = std::max(before_shown_s + 1e-3, h_s - lag_s(i));
    if (wanted_s <= shown_s) {
      const double fraction = (wanted_s - before_shown_s) / (shown_s - before_shown_s);
      return Duration::seconds(std::min(kMostLead * wanted_s, between(before_h_s, h_s, fraction)));
    }
    before_h_s = h_s;
    before_shown_s = shown_s;
  }
  return Duration::seconds(std::min(kMostLead * wanted_s, wanted_s + before_h_s - before_shown_s));
}

}  // namespace dance
