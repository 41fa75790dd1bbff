// RowStrip: a piece of a rectified row with its neighbours, sampled from a raw grey picture, and
// how well a patch fits along it.
//
// Units/frames: rectified pixels (producers/camera/stereo/rectified_pair.h); grey levels 0…255;
//               scores are correlations, -1…1.
// Ownership:    buffers of fixed size inside; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      is_inside() is false for columns whose rays leave the picture; scores there are
//               kNoScore.
// Source:       zero-mean normalised cross-correlation under a Gaussian window.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "producers/camera/stereo/rectified_pair.h"

namespace dance {

constexpr int kPatchRadius_px = 7;
constexpr int kPatchSide_px = 2 * kPatchRadius_px + 1;
constexpr int kMostStripColumns = 640;
constexpr float kNoScore = -2.0f;

class RowStrip {
 public:
  RowStrip();

  // Columns first_u_px, first_u_px + 1, … (at most kMostStripColumns), rows v_px ± kPatchRadius_px.
  // `valid` is the part of the grey picture that may be read.
  void sample(const cv::Mat& grey, const cv::Rect& valid, const RectifiedPair& pair, Side side,
              double first_u_px, double v_px, int columns);

  int columns() const { return columns_; }
  // The patch whose left edge is at this column lies in the picture.
  bool is_inside(int column) const {
    return column >= inside_first_ && column + kPatchSide_px <= inside_end_;
  }
  const float* row(int i) const { return samples_.data() + i * kMostStripColumns; }

 private:
  std::vector<float> samples_;  // kPatchSide_px rows
  int columns_ = 0;
  int inside_first_ = 0;
  int inside_end_ = 0;
};

// A patch as scores need it: zero mean, unit deviation under the window, multiplied by the window.
class Patch {
 public:
  // The one at the strip's column (of its left edge); false where it has no texture to speak of, or
  // lies outside.
  bool take(const RowStrip& strip, int column);
  // Grey levels under the window.
  float deviation() const { return deviation_; }
  // scores[i] is how well it fits at column i; as many as the strip has columns less kPatchSide_px
  // - 1.
  void scores_along(const RowStrip& strip, std::span<float> scores) const;

 private:
  std::array<float, kPatchSide_px * kPatchSide_px> values_;
  float deviation_ = 0.0f;
};

// Where between its neighbours a peak lies, -0.5…0.5: the top of the parabola through three scores.
inline double peak_offset(float before, float at, float after) {
  const double curve = static_cast<double>(before) - 2.0 * at + after;
  if (curve > -1e-9) return 0.0;
  const double offset = 0.5 * (static_cast<double>(before) - after) / curve;
  return offset < -0.5 ? -0.5 : offset > 0.5 ? 0.5 : offset;
}

}  // namespace dance
