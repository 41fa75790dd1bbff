// DanceMemory: the last twelve seconds of one dancer as rows, and which of their moments the
// present one is like.
//
// Units/frames: rows 60 a second; lags in rows; distances in m² (turns times the lever of their
//               bone).
// Ownership:    a ring of its own; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none; with too little to compare with there are no likenesses.
// Source:       nearest neighbours of a trajectory, as in Lee et al., Motion Fields, 2010; the
//               distance is followed from frame to frame for all lags at once.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "transformers/predict/model/body_net.h"
#include "transformers/predict/model/body_row.h"

namespace dance {

class DanceMemory {
 public:
  static constexpr std::size_t kLags = 704;  // 11.7 s
  static constexpr std::size_t kLikeMost = 12;
  static constexpr std::size_t kWindows = 2;  // alike over 0.3 s and over 2 s

  // Moments like the present, each with its weight; the weights sum to 1, or there are none.
  struct Likeness {
    std::size_t count = 0;
    std::array<std::size_t, kLikeMost> lag{};
    std::array<float, kLikeMost> weight{};
  };

  explicit DanceMemory(const std::array<float, kRowGroups>& lever);
  void clear();
  void push(const BodyRow& row);
  std::size_t size() const { return size_; }
  // The row of `lag` rows ago; lag < size().
  const BodyRow& operator()(std::size_t lag) const { return rows_[(newest_ + lag) & kMask]; }

  // Of moments that lie at least `least_lag` back.
  void find_likeness(std::size_t window, std::size_t least_lag, Likeness& likeness) const;

 private:
  static constexpr std::size_t kRing = 1024;
  static constexpr std::size_t kMask = kRing - 1;
  static constexpr std::size_t kStride = 1152;  // of a number's past, newest first

  std::vector<BodyRow> rows_;
  std::size_t newest_ = 0;
  std::size_t size_ = 0;
  // The numbers that are compared, each scaled by its lever, each with its past in one piece.
  std::vector<std::size_t> compared_;
  std::vector<float> scale_;
  std::vector<float> now_;
  std::vector<float> past_;
  std::size_t head_ = 0;
  std::array<std::vector<float>, kWindows> distances_;
  std::array<std::vector<float>, kWindows>
      heard_;  // how much of its window a lag has been heard over, by rows
};

}  // namespace dance
