#include "transformers/predict/blend/prediction_meter.h"

#include <algorithm>

namespace dance {
namespace {

constexpr double kForget = 0.99;  // per prediction of one distance: some twenty seconds
constexpr double kEnoughPredictions = 8.0;
// Predictions of one distance that the usual gain counts for.
constexpr double kUsualGainCounts = 15.0;
constexpr double kLeastGain = 0.9, kMostGain = 1.7;
// A wave of four beats turns by pi / 2 a beat.
constexpr double kWaveTurn_per_beat = 1.5707963;

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

PredictionLead PredictionMeter::measured_lead() {
  PredictionLead lead;
  lead.set_strength(1.0f);
  for (std::size_t h = 0; h < kHorizons.size(); ++h) lead.set_gain(h, 1.0f);
  return lead;
}

void PredictionMeter::note(const Pose& newest, const Pose& pose, MonoTime moment) {
  Prediction& prediction = predictions_[write_++ % predictions_.size()];
  prediction.moment = moment;
  prediction.horizon = next_;
  prediction.waits = true;
  body_positions(newest, prediction.from);
  body_positions(pose, prediction.to);
  next_ = (next_ + 1) % kHorizons.size();
}

bool PredictionMeter::learn(const PoseHistory& history, Duration beat) {
  if (history.size() < 4) return false;
  bool has_learned = false;
  for (Prediction& prediction : predictions_) {
    if (!prediction.waits || prediction.moment + beat > history.newest().capture_time) continue;
    prediction.waits = false;
    const auto truth = history.at(prediction.moment);
    // What fell into a gap of the line has no truth to be compared with.
    if (truth->how == PoseHistory::How::kHeldFirst || truth->how == PoseHistory::How::kHeldLast)
      continue;
    has_learned = true;
    Score& score = scores_[prediction.horizon];
    const float longer = gain(prediction.horizon);
    Places is;
    body_positions(truth->pose, is);
    double error_m = 0.0;
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const Eigen::Vector3f way = prediction.to[b] - prediction.from[b];
      error_m += static_cast<double>((prediction.from[b] + longer * way - is[b]).norm());
    }
    score.weight = kForget * score.weight + 1.0;
    score.error_m = kForget * score.error_m + error_m / (kBoneCount - 1);
    if (beat > Duration()) learn_wave(history, prediction, is, beat);
  }
  return has_learned;
}

void PredictionMeter::learn_wave(const PoseHistory& history, const Prediction& prediction,
                                 const Places& is, Duration beat) {
  // From a beat before to a beat after, half the four-count, is where its wave goes; of waves twice
  // as fast nothing is left. What is predicted and what was danced should go along with it alike.
  Places was, will;
  body_positions(history.at(prediction.moment - beat)->pose, was);
  body_positions(history.at(prediction.moment + beat)->pose, will);
  double danced = 0.0, predicted = 0.0, wave2 = 0.0;
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const Eigen::Vector3f wave = 0.5f * (will[b] - was[b]);
    danced += static_cast<double>((is[b] - prediction.from[b]).dot(wave));
    predicted += static_cast<double>((prediction.to[b] - prediction.from[b]).dot(wave));
    wave2 += static_cast<double>(wave.squaredNorm());
  }
  const double ahead_beats = kHorizons[prediction.horizon].as_seconds() / beat.as_seconds();
  Score& score = scores_[prediction.horizon];
  score.danced = kForget * score.danced + danced;
  score.predicted = kForget * score.predicted + predicted;
  score.wave2 = kForget * score.wave2 + wave2 * std::min(1.0, kWaveTurn_per_beat * ahead_beats);
  score.waves = kForget * score.waves + 1.0;
}

float PredictionMeter::gain(std::size_t horizon) const {
  const Score& score = scores_[horizon];
  const auto usual = static_cast<double>(PredictionLead::usual_gain(horizon));
  if (score.waves <= 0.0) return PredictionLead::usual_gain(horizon);
  // What is expected beforehand counts like some predictions that turned out so.
  const double beforehand = kUsualGainCounts * score.wave2 / score.waves;
  const double predicted = score.predicted + beforehand;
  if (predicted <= 0.1 * beforehand) return static_cast<float>(usual);
  return static_cast<float>(
      std::clamp((score.danced + usual * beforehand) / predicted, kLeastGain, kMostGain));
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

}  // namespace dance
