// Training of prediction's model from recorded dances: where bones usually are, the network
// (stochastic gradient on the dances, mirrored ones and trembling ones), and what each prediction
// is worth (least squares on dances that the network asked was not trained on).
//
// Units/frames: as transformers/predict/model/predict_model.h; takes are of 60 frames a second.
// Ownership:    plain values.
// Threads:      networks are trained beside each other, one thread each; the result does not depend
//               on it.
// Failure:      an Error names what is missing.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "research/predict/predict_takes.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

struct PredictTraining {
  std::vector<PredictTake> takes;
  int epochs = 32;
  int folds = 3;
  std::uint64_t seed = 1;
  std::function<void(const std::string&)>
      tell;  // progress, a line each; of several threads, one at a time
};

// Frames until a dancer has a past to look at; with the longest horizon behind them, what a take
// has at least.
constexpr std::size_t kFramesOfPast = 360;
constexpr std::size_t kLeastTakeFrames =
    kFramesOfPast + static_cast<std::size_t>(kHorizonFrames[kHorizons - 1]) + 1;

Result<PredictModel> train_predict(const PredictTraining& training);

// What a sensor trembles by, in the two sets of weights.
constexpr std::array<double, 2> kTrainedTremble_deg{0.0, 0.5};

// The parts, in the order they are run.
void fit_space(PredictModel& model, const std::vector<PredictTake>& takes);

// Moments as the network sees them, and how they went on, as levered ways; one after the other.
struct NetSamples {
  std::size_t count = 0;
  std::vector<float> inputs;  // kNetInputs each, as they are
  std::vector<float> ways;    // kWaySize each
};
constexpr std::size_t kWaySize = kHorizons * kRowSize;
void add_samples(const PredictModel& model, const PredictTake& take, double tremble_deg,
                 std::size_t every, Random& random, NetSamples& samples);
void fit_basis(PredictModel& model, const NetSamples& samples);
struct NetFit {  // as in PredictTraining
  int epochs;
  std::uint64_t seed;
  std::function<void(int epoch, double error)> tell;
};
void fit_net(PredictModel& model, const NetSamples& samples, const NetFit& fit);

// A take, the model whose network is asked, and what its moments count.
struct WeighedTake {
  const PredictTake* take;
  const PredictModel* model;
  double weight = 1.0;
};
// Weights of all kinds of groups at one trembling, by least squares; of a dancer seen for long, or
// met anew every five seconds.
KindWeights fit_weights(const std::vector<WeighedTake>& takes, double tremble_deg, bool asks_net,
                        bool is_just_met, float& tremble_rad);

}  // namespace dance
