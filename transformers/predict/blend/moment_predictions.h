// MomentPredictions: all ways of predicting how a moment goes on
// (transformers/predict/model/predict_model.h), as rows that are weighted and added. Computed once
// a row; kept, until it is known how the moment went on.
//
// Units/frames: differences of rows in the dancer's heading at that moment; slopes a row; horizons
//               as kHorizonFrames.
// Ownership:    plain value of 19 kB; allocates nothing.
// Threads:      none inside.
// Failure:      none; what cannot be predicted yet is a row of zeros.
#pragma once

#include <array>

#include "transformers/predict/model/body_net.h"
#include "transformers/predict/model/predict_model.h"
#include "transformers/predict/past/dance_memory.h"

namespace dance {

struct MomentPredictions {
  std::array<BodyRow, kCommonPredictions> common;
  std::array<std::array<BodyRow, kPredictions - kCommonPredictions>, kHorizons> by_horizon;
  // What was made of them: their weighted sum.
  BodyWays blended;
  // What the personal model corrects, the network's answer where that is asked, and its correction.
  BodyWays impersonal;
  BodyWays personal;

  const float* row(std::size_t horizon, std::size_t prediction) const {
    return prediction < kCommonPredictions
               ? common[prediction].v.data()
               : by_horizon[horizon][prediction - kCommonPredictions].v.data();
  }
};

// The way from one row to another, in the heading of the first.
inline BodyRow way_between(const BodyRow& from, const BodyRow& to) {
  BodyRow way;
  for (std::size_t i = 0; i < kRowSize; ++i) way.v[i] = to.v[i] - from.v[i];
  place_into_heading(way, from.heading());
  return way;
}

// Sums of the rows of the last 4 s, so that their mean costs nothing.
class RowMean {
 public:
  static constexpr std::size_t kRows = 240;
  void clear() { sum_.fill(0.0), count_ = 0; }
  // After the memory has taken the row in.
  void push(const DanceMemory& memory);
  // From the newest row to the mean; of the root only its height.
  void way_to_mean(const BodyRow& now, BodyRow& way) const;

 private:
  std::array<double, kRowSize> sum_{};
  std::size_t count_ = 0;
};

// Everything but the network's answer, which the caller writes.
void make_predictions(const DanceMemory& memory, const RowMean& mean,
                      MomentPredictions& predictions);

}  // namespace dance
