#include "producers/camera/stereo/row_strip.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"

namespace dance {
namespace {

// Rays are worked out at every so many columns, in the top and the bottom row; between them raw
// positions are straight lines to within a hundredth of a pixel.
constexpr int kNodeStep_px = 8;
// Below it a patch is the camera's noise.
constexpr float kLeastDeviation = 1.5f;

// The Gaussian window's factor along one axis, sum 1.
const std::array<float, kPatchSide_px>& window() {
  static const std::array<float, kPatchSide_px> made = [] {
    constexpr double kSpread_px = 4.0;
    std::array<float, kPatchSide_px> w{};
    double sum = 0.0;
    for (int i = 0; i < kPatchSide_px; ++i) {
      const double x = (i - kPatchRadius_px) / kSpread_px;
      w[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-0.5 * x * x));
      sum += w[static_cast<std::size_t>(i)];
    }
    for (float& value : w) value = static_cast<float>(value / sum);
    return w;
  }();
  return made;
}

struct RawLine {
  float x;
  float y;
  float dx;
  float dy;
};

// Columns from..to of one row, positions along the line; `valid` holds them all.
void sample_run(const cv::Mat& grey, RawLine line, int count, float* out) {
  const std::size_t step = grey.step;
  const std::uint8_t* data = grey.data;
  for (int i = 0; i < count; ++i) {
    const float x = line.x + static_cast<float>(i) * line.dx;
    const float y = line.y + static_cast<float>(i) * line.dy;
    const int xi = static_cast<int>(x);
    const int yi = static_cast<int>(y);
    const float fx = x - static_cast<float>(xi);
    const float fy = y - static_cast<float>(yi);
    const std::uint8_t* p =
        data + static_cast<std::size_t>(yi) * step + static_cast<std::size_t>(xi);
    const float top = static_cast<float>(p[0]) + fx * static_cast<float>(p[1] - p[0]);
    const float bottom =
        static_cast<float>(p[step]) + fx * static_cast<float>(p[step + 1] - p[step]);
    out[i] = top + fy * (bottom - top);
  }
}

bool holds(const cv::Rect& valid, const Eigen::Vector2d& p) {
  return p.x() >= valid.x && p.y() >= valid.y && p.x() < valid.x + valid.width - 1 &&
         p.y() < valid.y + valid.height - 1;
}

}  // namespace

RowStrip::RowStrip() : samples_(static_cast<std::size_t>(kPatchSide_px * kMostStripColumns)) {}

void RowStrip::sample(const cv::Mat& grey, const cv::Rect& valid, const RectifiedPair& pair,
                      Side side, double first_u_px, double v_px, int columns) {
  DANCE_ASSERT(grey.type() == CV_8UC1 && columns > 0 && columns <= kMostStripColumns);
  columns_ = columns;
  inside_first_ = inside_end_ = 0;
  bool was_inside = false;
  const auto top_at = [&](int c) {
    return pair.raw(side, {first_u_px + c, v_px - kPatchRadius_px});
  };
  const auto bottom_at = [&](int c) {
    return pair.raw(side, {first_u_px + c, v_px + kPatchRadius_px});
  };
  Eigen::Vector2d top = top_at(0);
  Eigen::Vector2d bottom = bottom_at(0);
  for (int c = 0; c < columns; c += kNodeStep_px) {
    const int next = c + kNodeStep_px;
    const Eigen::Vector2d next_top = top_at(next);
    const Eigen::Vector2d next_bottom = bottom_at(next);
    const int count = std::min(kNodeStep_px, columns - c);
    const bool is_in = holds(valid, top) && holds(valid, bottom) && holds(valid, next_top) &&
                       holds(valid, next_bottom);
    for (int r = 0; r < kPatchSide_px; ++r) {
      float* out = samples_.data() + r * kMostStripColumns + c;
      if (!is_in) {
        std::fill_n(out, count, 0.0f);
        continue;
      }
      const double part = static_cast<double>(r) / (kPatchSide_px - 1);
      const Eigen::Vector2d from = top + part * (bottom - top);
      const Eigen::Vector2d step =
          (next_top + part * (next_bottom - next_top) - from) / kNodeStep_px;
      sample_run(grey,
                 {static_cast<float>(from.x()), static_cast<float>(from.y()),
                  static_cast<float>(step.x()), static_cast<float>(step.y())},
                 count, out);
    }
    // What is inside is one run of columns: a picture has no holes.
    if (is_in && !was_inside) inside_first_ = c;
    if (is_in) inside_end_ = c + count;
    was_inside = is_in;
    top = next_top;
    bottom = next_bottom;
  }
}

bool Patch::take(const RowStrip& strip, int column) {
  deviation_ = 0.0f;
  if (column < 0 || !strip.is_inside(column)) return false;
  const auto& w = window();
  float mean = 0.0f;
  float square = 0.0f;
  for (int r = 0; r < kPatchSide_px; ++r) {
    const float* row = strip.row(r) + column;
    float row_mean = 0.0f;
    float row_square = 0.0f;
    for (std::size_t k = 0; k < w.size(); ++k) {
      row_mean += w[k] * row[k];
      row_square += w[k] * row[k] * row[k];
    }
    mean += w[static_cast<std::size_t>(r)] * row_mean;
    square += w[static_cast<std::size_t>(r)] * row_square;
  }
  deviation_ = std::sqrt(std::max(0.0f, square - mean * mean));
  if (deviation_ < kLeastDeviation) return false;
  float* out = values_.data();
  for (int r = 0; r < kPatchSide_px; ++r) {
    const float* row = strip.row(r) + column;
    const float scale = w[static_cast<std::size_t>(r)] / deviation_;
    for (std::size_t k = 0; k < w.size(); ++k) *out++ = scale * w[k] * (row[k] - mean);
  }
  return true;
}

// ZNCC(c) = Σ w·(l − m_l)·r / (s_l · s_r(c)),  s_r² = Σ w·r² − (Σ w·r)²; all sums under the window
// at column c.
void Patch::scores_along(const RowStrip& strip, std::span<float> scores) const {
  const int count = strip.columns() - kPatchSide_px + 1;
  DANCE_ASSERT(static_cast<int>(scores.size()) >= count);
  const auto& w = window();
  std::array<float, kMostStripColumns> column_mean{};
  std::array<float, kMostStripColumns> column_square{};
  std::array<float, kMostStripColumns> product{};
  for (int r = 0; r < kPatchSide_px; ++r) {
    const float* row = strip.row(r);
    const float wr = w[static_cast<std::size_t>(r)];
    for (int c = 0; c < strip.columns(); ++c) {
      column_mean[static_cast<std::size_t>(c)] += wr * row[c];
      column_square[static_cast<std::size_t>(c)] += wr * row[c] * row[c];
    }
    for (int k = 0; k < kPatchSide_px; ++k) {
      const float value = values_[static_cast<std::size_t>(r * kPatchSide_px + k)];
      float* out = product.data();
      const float* in = row + k;
      for (int c = 0; c < count; ++c) out[c] += value * in[c];
    }
  }
  for (int c = 0; c < count; ++c) {
    float& score = scores[static_cast<std::size_t>(c)];
    score = kNoScore;
    if (!strip.is_inside(c)) continue;
    float mean = 0.0f;
    float square = 0.0f;
    for (std::size_t k = 0; k < w.size(); ++k) {
      mean += w[k] * column_mean[static_cast<std::size_t>(c) + k];
      square += w[k] * column_square[static_cast<std::size_t>(c) + k];
    }
    const float deviation = std::sqrt(std::max(0.0f, square - mean * mean));
    if (deviation >= kLeastDeviation)
      score = std::clamp(product[static_cast<std::size_t>(c)] / deviation, -1.0f, 1.0f);
  }
}

}  // namespace dance
