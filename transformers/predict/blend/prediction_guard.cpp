#include "transformers/predict/blend/prediction_guard.h"

#include <algorithm>
#include <cmath>

#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

// 30 moments a second: half-lives of 0.45 s and of 2.3 s.
constexpr float kLatelyKeep = 0.95f, kLongerKeep = 0.99f;
// What each counts. What is wrong near at hand is known before what is wrong further ahead: the
// three horizons before are heard too.
constexpr float kLatelyWeight = 0.5f, kLongerWeight = 0.5f, kNearerWeight = 0.33f;
constexpr std::size_t kNearerHorizons = 3;
// A few moments say little yet; until then the others count as so much worse than the prediction.
constexpr float kFewMoments = 6.0f;
constexpr float kBeforehand = 0.1f;
// An error counts less and less from about so many radians (metres, of the place) on, and so many
// more a second ahead: one limb that was lost for a frame says little of the seconds around it.
constexpr float kWildError = 0.5f, kWildError_s = 1.0f;
// A bone's errors are few and rough: so much of the whole body's is among them.
constexpr float kOfTheBody = 0.1f;
// How steeply a worse candidate counts less: by about exp(-kSharp × its error's excess).
constexpr float kSharp = 24.0f;
// m: what no sensor sees; errors of a body that stands like stone are all alike.
constexpr float kFloor_m = 1e-6f;
constexpr float kDampedRows = 6.0f;  // 100 ms
// Root of the sum of all joints' squared speeds, m/s: less is standing.
constexpr float kMoving_m_s = 0.4f;

// Of each candidate, the parts of the prediction, of going on and of going on damped; the rest
// stands still.
constexpr std::array<std::array<float, 3>, 7> kParts{{{1.0f, 0.0f, 0.0f},
                                                      {0.0f, 0.0f, 0.0f},
                                                      {0.0f, 1.0f, 0.0f},
                                                      {0.0f, 0.0f, 1.0f},
                                                      {0.5f, 0.0f, 0.0f},
                                                      {0.5f, 0.0f, 0.5f},
                                                      {0.0f, 0.0f, 0.5f}}};

const float* slope_of(const MomentPredictions& predictions, Prediction prediction) {
  return predictions.common[static_cast<std::size_t>(prediction)].v.data();
}

// The prediction, and what anyone can do: rows of numbers, and how many times each counts.
struct Sources {
  std::array<const float*, 3> rows;
  std::array<float, 3> times;
};

Sources sources_of(const MomentPredictions& predictions, std::size_t horizon) {
  const auto rows = static_cast<float>(kHorizonFrames[horizon]);
  const float damped = kDampedRows * (1.0f - std::exp(-rows / kDampedRows));
  return {{predictions.blended[horizon].v.data(), slope_of(predictions, Prediction::kSlope1),
           slope_of(predictions, Prediction::kSlope6)},
          {1.0f, rows, damped}};
}

// Near to exp(-x) for x >= 0, and the same bits on every processor.
float falling(float x) {
  const float y = 1.0f + 0.125f * x, y2 = y * y, y4 = y2 * y2;
  return 1.0f / (y4 * y4);
}

std::size_t state_of(const MomentPredictions& predictions,
                     const std::array<float, kRowGroups>& lever) {
  const float* slope = slope_of(predictions, Prediction::kSlope12);
  float squares = 0.0f;
  for (std::size_t g = 0; g < kBoneCount; ++g)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float speed = lever[g] * slope[BodyRow::at(g, axis)];
      squares += speed * speed;
    }
  const auto hz = static_cast<float>(kGridHz);
  return squares * hz * hz > kMoving_m_s * kMoving_m_s ? 1 : 0;
}

}  // namespace

PredictionGuard::PredictionGuard(const std::array<float, kRowGroups>& lever) : lever_(lever) {
  clear();
}

void PredictionGuard::clear() {
  horizons_ = {};
  for (std::size_t h = 0; h < kHorizons; ++h)
    for (std::size_t state = 0; state < kStates; ++state) weigh(h, state);
}

void PredictionGuard::forget_lately() {
  for (auto& states : horizons_)
    for (Horizon& horizon : states) horizon.lately = {};
}

DANCE_WIDE_VECTORS void PredictionGuard::learn(std::size_t h, const MomentPredictions& predictions,
                                               const BodyRow& way) {
  const Sources sources = sources_of(predictions, h);
  const std::size_t state = state_of(predictions, lever_);
  Horizon& horizon = horizons_[h][state];
  for (Kept* kept : {&horizon.lately, &horizon.longer}) {
    const float keep = kept == &horizon.lately ? kLatelyKeep : kLongerKeep;
    kept->heard_moments = keep * kept->heard_moments + 1.0f;
  }
  ByCandidate squares{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t g = 0; g < kRowGroups; ++g) {
      const std::size_t i = BodyRow::at(g, axis);
      const float still = -way.v[i];
      const float ours = sources.rows[0][i] + still;
      const float going_on = sources.times[1] * sources.rows[1][i] + still;
      const float damped = sources.times[2] * sources.rows[2][i] + still;
      // In the order of kParts.
      const std::array<float, kCandidates> errors{ours,
                                                  still,
                                                  going_on,
                                                  damped,
                                                  0.5f * (ours + still),
                                                  0.5f * (ours + damped),
                                                  0.5f * (still + damped)};
      for (std::size_t k = 0; k < kCandidates; ++k) squares[k][g] += errors[k] * errors[k];
    }
  const float wild = kWildError + kWildError_s * static_cast<float>(kHorizonFrames[h] / kGridHz);
  // Lengths, not their squares: what is seen of an error is how far it is.
  for (Groups& errors : squares)
    for (std::size_t g = 0; g < kRowGroups; ++g) {
      const float error = std::sqrt(errors[g]);
      errors[g] = lever_[g] * error / (1.0f + error / wild);
    }
  std::array<float, kCandidates> body{};
  for (std::size_t g = 0; g < kBoneCount; ++g)
    for (std::size_t k = 0; k < kCandidates; ++k) body[k] += squares[k][g];
  for (std::size_t k = 0; k < kCandidates; ++k) {
    Groups& errors = squares[k];
    // Where the hips go is seen by itself: joints that only tremble say nothing about it.
    const float of_place = errors[kPlaceGroup];
    for (std::size_t g = 0; g < kRowGroups; ++g) errors[g] += kOfTheBody * body[k];
    errors[kPlaceGroup] = of_place;
    for (std::size_t g = 0; g < kRowGroups; ++g) {
      horizon.lately.sum[k][g] = kLatelyKeep * horizon.lately.sum[k][g] + errors[g];
      horizon.longer.sum[k][g] = kLongerKeep * horizon.longer.sum[k][g] + errors[g];
    }
  }
  weigh(h, state);
}

DANCE_WIDE_VECTORS void PredictionGuard::weigh(std::size_t h, std::size_t state) {
  Horizon& horizon = horizons_[h][state];
  const auto known = [](const Kept& kept) {
    return kept.heard_moments / (kept.heard_moments + kFewMoments);
  };
  // How much worse than the prediction each has been, as a part of its error.
  ByCandidate excess{};
  const float beforehand = kBeforehand * (1.0f - known(horizon.longer));
  for (std::size_t k = 1; k < kCandidates; ++k) excess[k].fill(beforehand);
  const auto add = [&](const Kept& kept, float weight) {
    const float counts = weight * known(kept);
    Groups per_error;
    for (std::size_t g = 0; g < kRowGroups; ++g)
      per_error[g] = counts / (kept.sum[0][g] + kFloor_m);
    for (std::size_t k = 1; k < kCandidates; ++k)
      for (std::size_t g = 0; g < kRowGroups; ++g)
        excess[k][g] += per_error[g] * kept.sum[k][g] - counts;
  };
  add(horizon.longer, kLongerWeight);
  add(horizon.lately, kLatelyWeight);
  for (std::size_t nearer = h - std::min(h, kNearerHorizons); nearer < h; ++nearer)
    add(horizons_[nearer][state].lately, kNearerWeight);

  Groups least{}, sum{};
  for (std::size_t k = 1; k < kCandidates; ++k)
    for (std::size_t g = 0; g < kRowGroups; ++g) least[g] = std::min(least[g], excess[k][g]);
  horizon.parts = {};
  for (std::size_t k = 0; k < kCandidates; ++k)
    for (std::size_t g = 0; g < kRowGroups; ++g) {
      const float counts = falling(kSharp * (excess[k][g] - least[g]));
      sum[g] += counts;
      for (std::size_t s = 0; s < 3; ++s) horizon.parts[s][g] += counts * kParts[k][s];
    }
  for (Groups& part : horizon.parts)
    for (std::size_t g = 0; g < kRowGroups; ++g) part[g] /= sum[g];
}

DANCE_WIDE_VECTORS void PredictionGuard::finish(std::size_t h, const MomentPredictions& predictions,
                                                BodyRow& way) const {
  const Sources sources = sources_of(predictions, h);
  const Horizon& horizon = horizons_[h][state_of(predictions, lever_)];
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t g = 0; g < kRowGroups; ++g) {
      const std::size_t i = BodyRow::at(g, axis);
      float sum = 0.0f;
      for (std::size_t s = 0; s < 3; ++s)
        sum += horizon.parts[s][g] * sources.times[s] * sources.rows[s][i];
      way.v[i] = sum;
    }
}

}  // namespace dance
