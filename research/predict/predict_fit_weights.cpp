#include <Eigen/Cholesky>
#include <cmath>
#include <memory>

#include "research/predict/predict_training.h"
#include "transformers/predict/dance_predictor.h"
#include "transformers/predict/past/motion_bounds.h"

namespace dance {
namespace {

constexpr std::size_t kWeighEvery = 4;
constexpr double kWeightRidge = 1e-3;
// Frames: a dancer is met anew; the network can be asked.
constexpr std::size_t kMetEvery = 300;
constexpr std::size_t kHasHistory = kNetHistory;

using Gram = Eigen::Matrix<double, kPredictions, kPredictions>;
using Cross = Eigen::Matrix<double, kPredictions, 1>;

struct WeightSums {
  Gram gram = Gram::Zero();
  Cross cross = Cross::Zero();
};
using AllSums = std::array<std::array<WeightSums, kHorizons>, kWeightKinds>;

void add_moment(const PredictModel& model, const MomentPredictions& predictions, std::size_t h,
                const BodyRow& way, double weight, AllSums& sums) {
  for (std::size_t g = 0; g < kRowGroups; ++g)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t i = BodyRow::at(g, axis);
      Cross features;
      for (std::size_t e = 0; e < kPredictions; ++e)
        features[static_cast<Eigen::Index>(e)] =
            static_cast<double>(predictions.row(h, e)[i] * model.lever[g]);
      if (features.squaredNorm() == 0.0) continue;
      WeightSums& sum = sums[kKindOfGroup[g]][h];
      sum.gram += weight * features * features.transpose();
      sum.cross += weight * features * static_cast<double>(way.v[i] * model.lever[g]);
    }
}

}  // namespace

KindWeights fit_weights(const std::vector<WeighedTake>& takes, double tremble_deg, bool asks_net,
                        bool is_just_met, float& tremble_rad) {
  auto sums = std::make_unique<AllSums>();
  double trembles = 0.0;
  std::size_t moments = 0;
  Random random(7);
  constexpr auto kLongest = static_cast<std::size_t>(kHorizonFrames[kHorizons - 1]);
  for (const WeighedTake& weighed : takes) {
    // Not owned: the predictor goes before the model does.
    DancePredictor predictor(std::shared_ptr<const PredictModel>(weighed.model, [](auto*) {}));
    predictor.set_acquaintance(asks_net ? Acquaintance::kOthers : Acquaintance::kNone);
    const BodySpace space(weighed.model->centres);
    auto heard = trembling(weighed.take->poses, tremble_deg, random);
    if (is_just_met)
      for (std::size_t i = 0; i < heard.size(); ++i)
        heard[i].capture_time += Duration::s(2 * static_cast<std::int64_t>(i / kMetEvery));
    const std::size_t first = (is_just_met ? kHasHistory : kFramesOfPast) + kLongest;
    std::vector<BodyRow> danced;
    for (std::size_t i = 0; i < heard.size(); ++i) {
      predictor.observe(heard[i]);
      danced.push_back(
          space.row_of(weighed.take->poses[i], danced.empty() ? nullptr : &danced.back()));
      // The moment of a second ago, as it was predicted then, against the dance as it went.
      if ((is_just_met ? i % kMetEvery : i) < first || i % kWeighEvery != 0) continue;
      trembles += static_cast<double>(predictor.tremble_rad());
      ++moments;
      const std::size_t then = i - kLongest;
      const BodyRow& from = predictor.memory()(kLongest);
      for (std::size_t h = 0; h < kHorizons; ++h) {
        BodyRow to = danced[then + static_cast<std::size_t>(kHorizonFrames[h])];
        // Headings are counted on alike.
        to(kHeadingGroup, 0) +=
            6.28318531f * std::round((from.heading() - to.heading()) / 6.28318531f);
        BodyRow way = way_between(from, to);
        bound_motion(h, way);
        add_moment(*weighed.model, predictor.predictions(kLongest), h, way, weighed.weight, *sums);
      }
    }
  }
  KindWeights weights{};
  for (std::size_t kind = 0; kind < kWeightKinds; ++kind)
    for (std::size_t h = 0; h < kHorizons; ++h) {
      Gram gram = (*sums)[kind][h].gram;
      gram.diagonal() *= 1.0 + kWeightRidge;
      gram.diagonal().array() += 1e-9;
      const Cross solved = gram.llt().solve((*sums)[kind][h].cross);
      for (std::size_t e = 0; e < kPredictions; ++e)
        weights[kind][h][e] = static_cast<float>(solved[static_cast<Eigen::Index>(e)]);
      if (!asks_net) weights[kind][h][static_cast<std::size_t>(Prediction::kNet)] = 0.0f;
    }
  tremble_rad =
      static_cast<float>(trembles / static_cast<double>(std::max<std::size_t>(moments, 1)));
  return weights;
}

}  // namespace dance
