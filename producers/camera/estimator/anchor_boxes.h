// AnchorBoxes: what a detector of the single-shot kind gives: a box and points for each place of
// its grids. Boxes that mean the same thing are merged, weighed by their scores.
//
// Units/frames: 0…1 of the square that the network looks at, x right and y down.
// Ownership:    keeps its boxes; allocates nothing after construction.
// Threads:      none inside.
// Failure:      numbers that are not finite are left out.
// Source:       Liu et al., SSD: Single Shot MultiBox Detector, ECCV 2016; weighted merging:
//               Bazarevsky et al., BlazeFace, 2019.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace dance {

struct AnchorGrid {
  int cells = 0;    // in a row, and rows
  int anchors = 0;  // in each cell
};

struct AnchorBox {
  static constexpr std::size_t kMostNumbers = 16;
  static constexpr std::size_t kBoxNumbers = 4;
  float score = 0.0f;  // 0…1
  // Left, top, right, bottom, then x and y of points.
  std::array<float, kMostNumbers> at{};
  Eigen::Vector2f point(std::size_t i) const {
    return {at[kBoxNumbers + 2 * i], at[kBoxNumbers + 2 * i + 1]};
  }
};

class AnchorBoxes {
 public:
  // `numbers` for each anchor, at most AnchorBox::kMostNumbers; the network's picture is side_px
  // across.
  AnchorBoxes(std::span<const AnchorGrid> grids, std::size_t numbers, float side_px);

  // Those with at least this score. `scores` before the sigmoid; one for each anchor.
  void decode(std::span<const float> boxes, std::span<const float> scores, float least_score);
  bool is_empty() const { return boxes_.empty(); }
  // The surest of them with all that mean the same, which are then no longer there.
  AnchorBox take_surest();

 private:
  std::size_t numbers_;
  float side_px_;
  std::vector<Eigen::Vector2f> anchors_;
  std::vector<AnchorBox> boxes_;  // the surest first
};

}  // namespace dance
