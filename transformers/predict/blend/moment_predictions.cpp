#include "transformers/predict/blend/moment_predictions.h"

#include <algorithm>

#include "transformers/predict/model/row_kernels.h"
#include "transformers/predict/past/motion_bounds.h"

namespace dance {
namespace {

// From where on a moment of the past is far enough back: for horizons up to 400 ms, and for the
// longer ones.
constexpr std::array<std::size_t, 2> kLeastLags{24, 60};
constexpr std::size_t kNearHorizons = 6;
constexpr std::array<std::size_t, 4> kSlopeRows{1, 3, 6, 12};

BodyRow& common(MomentPredictions& predictions, Prediction prediction) {
  return predictions.common[static_cast<std::size_t>(prediction)];
}

// Least squares over the last rows + 1 rows: slope = sum (i - middle) x_i / sum (i - middle)².
void add_slope(const DanceMemory& memory, std::size_t rows, float cosine, float sine,
               BodyRow& slope) {
  slope.v.fill(0.0f);
  const std::size_t used = std::min(rows, memory.size() - 1);
  if (used == 0) return;
  const float middle = 0.5f * static_cast<float>(used);
  float size = 0.0f;
  for (std::size_t l = 0; l <= used; ++l) {
    const float arm = middle - static_cast<float>(l);
    size += arm * arm;
    add_scaled(arm, memory(l).v.data(), kRowSize, slope.v.data());
  }
  for (float& x : slope.v) x /= size;
  bound_slope(slope);
  turn_place(slope, sine, cosine);
}

// Sums of ways of one moment of the past, turned into the heading that it had.
class WaySum {
 public:
  WaySum(float heading, float weight)
      : sine_(-std::sin(heading)), cosine_(std::cos(heading)), weight_(weight) {}
  void add(const BodyRow& from, const BodyRow& to, BodyRow& sum) const {
    add_difference(weight_, from.v.data(), to.v.data(), kRowSize, sum.v.data());
    // Of the place the turned way, not the one in W.
    constexpr std::size_t kX = BodyRow::at(kPlaceGroup, 0), kZ = BodyRow::at(kPlaceGroup, 2);
    const float x = weight_ * (to.v[kX] - from.v[kX]), z = weight_ * (to.v[kZ] - from.v[kZ]);
    sum.v[kX] += cosine_ * x + sine_ * z - x;
    sum.v[kZ] += cosine_ * z - sine_ * x - z;
  }

 private:
  float sine_, cosine_, weight_;
};

void add_likeness(const DanceMemory& memory, const DanceMemory::Likeness& likeness,
                  std::size_t first, std::size_t last, std::size_t window,
                  MomentPredictions& predictions) {
  for (std::size_t k = 0; k < likeness.count; ++k) {
    const std::size_t lag = likeness.lag[k];
    const BodyRow& then = memory(lag);
    const WaySum ways(then.heading(), likeness.weight[k]);
    for (std::size_t h = first; h < last; ++h)
      ways.add(then, memory(lag - static_cast<std::size_t>(kHorizonFrames[h])),
               predictions.by_horizon[h][window]);
  }
}

}  // namespace

void RowMean::push(const DanceMemory& memory) {
  for (std::size_t i = 0; i < kRowSize; ++i) sum_[i] += static_cast<double>(memory(0).v[i]);
  if (count_ < kRows) {
    ++count_;
    return;
  }
  for (std::size_t i = 0; i < kRowSize; ++i) sum_[i] -= static_cast<double>(memory(kRows).v[i]);
}

void RowMean::way_to_mean(const BodyRow& now, BodyRow& way) const {
  way.v.fill(0.0f);
  if (count_ == 0) return;
  for (std::size_t i = 0; i < kRowSize; ++i)
    way.v[i] = static_cast<float>(sum_[i] / static_cast<double>(count_)) - now.v[i];
  // Where the dancer stands and looks has no mean that would draw them.
  way(kPlaceGroup, 0) = way(kPlaceGroup, 2) = way(kHeadingGroup, 0) = 0.0f;
}

void make_predictions(const DanceMemory& memory, const RowMean& mean,
                      MomentPredictions& predictions) {
  const BodyRow& now = memory(0);
  const float sine = -std::sin(now.heading()), cosine = std::cos(now.heading());
  for (std::size_t s = 0; s < kSlopeRows.size(); ++s)
    add_slope(memory, kSlopeRows[s], cosine, sine, predictions.common[s]);
  mean.way_to_mean(now, common(predictions, Prediction::kReturn));
  for (auto& rows : predictions.by_horizon)
    for (BodyRow& row : rows) row.v.fill(0.0f);
  constexpr std::array<Prediction, 4> kLike{Prediction::kLikeShort, Prediction::kLikeShortSlope,
                                            Prediction::kLikeLong, Prediction::kLikeLongSlope};
  for (const Prediction prediction : kLike) common(predictions, prediction).v.fill(0.0f);
  DanceMemory::Likeness likeness;
  for (std::size_t w = 0; w < DanceMemory::kWindows; ++w) {
    memory.find_likeness(w, kLeastLags[1], likeness);
    add_likeness(memory, likeness, kNearHorizons, kHorizons, w, predictions);
    memory.find_likeness(w, kLeastLags[0], likeness);
    add_likeness(memory, likeness, 0, kNearHorizons, w, predictions);
    BodyRow& stood = common(predictions, kLike[2 * w]);
    BodyRow& went = common(predictions, kLike[2 * w + 1]);
    for (std::size_t k = 0; k < likeness.count; ++k) {
      const BodyRow& then = memory(likeness.lag[k]);
      add_difference(likeness.weight[k], now.v.data(), then.v.data(), kRowSize, stood.v.data());
      const BodyRow& before = memory(likeness.lag[k] + 1);
      WaySum(before.heading(), likeness.weight[k]).add(before, then, went);
    }
    stood(kPlaceGroup, 0) = stood(kPlaceGroup, 2) = stood(kHeadingGroup, 0) = 0.0f;
  }
}

}  // namespace dance
