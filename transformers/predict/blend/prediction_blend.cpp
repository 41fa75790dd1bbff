#include "transformers/predict/blend/prediction_blend.h"

#include <cmath>

#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

// A half-life of 14 s at 30 moments a second.
constexpr float kKeep = 0.99835f;
// How much the prior counts against what was heard, by horizon; and beside it while little was
// heard. On salsa both held and left out, and on another dance, less lets the weights follow noise.
constexpr std::array<float, kHorizons> kRidge{0.05f, 0.08f, 0.15f, 0.2f, 0.3f, 0.5f, 1.0f, 3.0f};
constexpr float kFirstWeight = 1500.0f;
constexpr float kFirstMoments = 30.0f;
// How soon the usual error is known, as a share of a moment's; and what is none, rad.
constexpr float kUsualShare = 0.02f;
constexpr float kLeastError = 1e-4f;

}  // namespace

PredictionBlend::PredictionBlend()
    : horizons_(std::make_unique<std::array<Horizon, kHorizons>>()) {}

void PredictionBlend::clear() {
  for (Horizon& horizon : *horizons_) {
    horizon.pairs.fill(0.0f);
    horizon.targets.fill(0.0f);
    horizon.usual_error.fill(0.0f);
    horizon.weights = horizon.prior;
    horizon.heard = 0.0f;
  }
}

void PredictionBlend::set_prior(const KindWeights& prior) {
  for (std::size_t h = 0; h < kHorizons; ++h) {
    Horizon& horizon = (*horizons_)[h];
    for (std::size_t e = 0; e < kPredictions; ++e)
      for (std::size_t g = 0; g < kRowGroups; ++g)
        horizon.prior[e * kRowGroups + g] = prior[kKindOfGroup[g]][h][e];
    if (horizon.heard == 0.0f) horizon.weights = horizon.prior;
  }
}

DANCE_WIDE_VECTORS void PredictionBlend::learn(std::size_t h, const MomentPredictions& predictions,
                                               const BodyRow& way) {
  Horizon& horizon = (*horizons_)[h];
  std::array<const float*, kPredictions> rows;
  for (std::size_t e = 0; e < kPredictions; ++e) rows[e] = predictions.row(h, e);
  // What is to be small is how far off a bone is, not the square of that.
  std::array<float, kRowGroups> counts;
  for (std::size_t g = 0; g < kRowGroups; ++g) {
    float square = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float error = way(g, axis) - predictions.blended[h](g, axis);
      square += error * error;
    }
    const float error = std::sqrt(square);
    float& usual = horizon.usual_error[g];
    usual = horizon.heard == 0.0f ? error : usual + kUsualShare * (error - usual);
    counts[g] = 1.0f / (1.0f + error / (usual + kLeastError));
  }
  follow_gram(rows.data(), kPredictions, way.v.data(), counts.data(), kKeep, horizon.pairs.data(),
              horizon.targets.data());
  horizon.heard = kKeep * horizon.heard + 1.0f;
}

void PredictionBlend::solve(std::size_t h) {
  Horizon& horizon = (*horizons_)[h];
  if (horizon.heard < kFirstMoments) return;
  solve_groups(horizon.pairs.data(), horizon.targets.data(), kPredictions,
               kRidge[h] * (1.0f + kFirstWeight / horizon.heard), horizon.prior.data(),
               horizon.weights.data());
}

void PredictionBlend::blend(std::size_t h, const MomentPredictions& predictions,
                            BodyRow& way) const {
  const Horizon& horizon = (*horizons_)[h];
  std::array<const float*, kPredictions> rows;
  for (std::size_t e = 0; e < kPredictions; ++e) rows[e] = predictions.row(h, e);
  weigh_rows(rows.data(), kPredictions, horizon.weights.data(), way.v.data());
}

}  // namespace dance
