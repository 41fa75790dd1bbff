#include "transformers/predict/model/row_kernels.h"

#include <cmath>

#include "transformers/predict/model/body_row.h"

namespace dance {
namespace {

constexpr std::size_t kG = kRowGroups;
constexpr std::size_t kMostFeatures = 16;

}  // namespace

DANCE_WIDE_VECTORS void add_product(const float* __restrict x, std::size_t rows,
                                    const float* __restrict matrix, std::size_t columns,
                                    float* __restrict y) {
  // Four rows a turn, of those whose x is not 0: y is read and written once for them, and added to
  // in their order.
  std::size_t i = 0;
  while (i < rows) {
    float a[4];
    const float* m[4];
    std::size_t count = 0;
    for (; i < rows && count < 4; ++i) {
      a[count] = x[i];
      m[count] = matrix + i * columns;
      count += x[i] != 0.0f ? 1 : 0;
    }
    if (count < 4) {
      for (std::size_t r = 0; r < count; ++r)
        for (std::size_t j = 0; j < columns; ++j) y[j] += a[r] * m[r][j];
      continue;
    }
    const float *m0 = m[0], *m1 = m[1], *m2 = m[2], *m3 = m[3];
    for (std::size_t j = 0; j < columns; ++j) {
      float sum = y[j] + a[0] * m0[j];
      sum += a[1] * m1[j];
      sum += a[2] * m2[j];
      sum += a[3] * m3[j];
      y[j] = sum;
    }
  }
}

DANCE_WIDE_VECTORS void add_two_products(const float* __restrict x, const float* __restrict z,
                                         std::size_t rows, const float* __restrict matrix,
                                         std::size_t columns, float* __restrict y,
                                         float* __restrict w) {
  std::size_t i = 0;
  for (; i + 4 <= rows; i += 4) {
    const float a = x[i], b = x[i + 1], c = x[i + 2], d = x[i + 3];
    const float e = z[i], f = z[i + 1], g = z[i + 2], h = z[i + 3];
    const float* m = matrix + i * columns;
    for (std::size_t j = 0; j < columns; ++j) {
      const float m0 = m[j], m1 = m[columns + j], m2 = m[2 * columns + j], m3 = m[3 * columns + j];
      y[j] = y[j] + a * m0 + b * m1 + c * m2 + d * m3;
      w[j] = w[j] + e * m0 + f * m1 + g * m2 + h * m3;
    }
  }
  for (; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) {
      y[j] += x[i] * matrix[i * columns + j];
      w[j] += z[i] * matrix[i * columns + j];
    }
}

DANCE_WIDE_VECTORS void add_scaled(float a, const float* __restrict x, std::size_t count,
                                   float* __restrict y) {
  for (std::size_t j = 0; j < count; ++j) y[j] += a * x[j];
}

DANCE_WIDE_VECTORS void add_difference(float weight, const float* __restrict from,
                                       const float* __restrict to, std::size_t count,
                                       float* __restrict sum) {
  for (std::size_t j = 0; j < count; ++j) sum[j] += weight * (to[j] - from[j]);
}

DANCE_WIDE_VECTORS void weigh_rows(const float* const* rows, std::size_t count,
                                   const float* __restrict weights, float* __restrict way) {
  float sum[kRowSize] = {};
  for (std::size_t e = 0; e < count; ++e) {
    const float* row = rows[e];
    const float* weight = weights + e * kG;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t g = 0; g < kG; ++g) sum[axis * kG + g] += weight[g] * row[axis * kG + g];
  }
  for (std::size_t i = 0; i < kRowSize; ++i) way[i] = sum[i];
}

DANCE_WIDE_VECTORS void follow_distances(const float* __restrict now, std::size_t dimensions,
                                         const float* __restrict past, std::size_t stride,
                                         std::size_t lags, float* __restrict distances,
                                         float keep_a, float* __restrict distances_b,
                                         float keep_b) {
  constexpr std::size_t kBlock = 64;
  for (std::size_t begin = 0; begin < lags; begin += kBlock) {
    const std::size_t n = lags - begin < kBlock ? lags - begin : kBlock;
    float sum[kBlock] = {};
    for (std::size_t d = 0; d < dimensions; ++d) {
      const float* p = past + d * stride + begin;
      for (std::size_t l = 0; l < kBlock; ++l) {
        const float difference = now[d] - p[l];
        sum[l] += difference * difference;
      }
    }
    for (std::size_t l = 0; l < n; ++l) {
      distances[begin + l] = keep_a * distances[begin + l] + sum[l];
      distances_b[begin + l] = keep_b * distances_b[begin + l] + sum[l];
    }
  }
}

DANCE_WIDE_VECTORS void find_least(const float* __restrict x, std::size_t count,
                                   std::uint8_t* __restrict is_least) {
  for (std::size_t i = 1; i + 1 < count; ++i)
    is_least[i] = static_cast<std::uint8_t>(!(x[i] > x[i - 1]) & !(x[i] > x[i + 1]));
}

DANCE_WIDE_VECTORS void follow_gram(const float* const* features, std::size_t count,
                                    const float* __restrict y, const float* __restrict counts,
                                    float keep, float* __restrict pairs,
                                    float* __restrict targets) {
  std::size_t pair = 0;
  float a[3 * kG];
  for (std::size_t e = 0; e < count; ++e) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t g = 0; g < kG; ++g)
        a[axis * kG + g] = counts[g] * features[e][axis * kG + g];
    for (std::size_t f = e; f < count; ++f, ++pair) {
      const float* b = features[f];
      float* out = pairs + pair * kG;
      for (std::size_t g = 0; g < kG; ++g)
        out[g] =
            keep * out[g] + a[g] * b[g] + a[kG + g] * b[kG + g] + a[2 * kG + g] * b[2 * kG + g];
    }
    float* out = targets + e * kG;
    for (std::size_t g = 0; g < kG; ++g)
      out[g] = keep * out[g] + a[g] * y[g] + a[kG + g] * y[kG + g] + a[2 * kG + g] * y[2 * kG + g];
  }
}

DANCE_WIDE_VECTORS void solve_groups(const float* __restrict pairs, const float* __restrict targets,
                                     std::size_t count, float ridge, const float* __restrict prior,
                                     float* __restrict weights) {
  // L of every group at once, by columns.
  float lower[kMostFeatures * kMostFeatures][kG];
  float x[kMostFeatures][kG];
  std::size_t pair = 0;
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t f = e; f < count; ++f, ++pair)
      for (std::size_t g = 0; g < kG; ++g) lower[f * kMostFeatures + e][g] = pairs[pair * kG + g];
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t g = 0; g < kG; ++g) {
      float& diagonal = lower[e * kMostFeatures + e][g];
      // Beside a feature that is as good as nothing stands the prior alone.
      const float held = ridge * diagonal + 1e-9f;
      x[e][g] = targets[e * kG + g] + held * prior[e * kG + g];
      diagonal += held;
    }
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t g = 0; g < kG; ++g) {
      float& diagonal = lower[k * kMostFeatures + k][g];
      diagonal = 1.0f / std::sqrt(diagonal > 1e-12f ? diagonal : 1e-12f);
    }
    for (std::size_t i = k + 1; i < count; ++i)
      for (std::size_t g = 0; g < kG; ++g)
        lower[i * kMostFeatures + k][g] *= lower[k * kMostFeatures + k][g];
    for (std::size_t i = k + 1; i < count; ++i)
      for (std::size_t j = k + 1; j <= i; ++j)
        for (std::size_t g = 0; g < kG; ++g)
          lower[i * kMostFeatures + j][g] -=
              lower[i * kMostFeatures + k][g] * lower[j * kMostFeatures + k][g];
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k)
      for (std::size_t g = 0; g < kG; ++g) x[i][g] -= lower[i * kMostFeatures + k][g] * x[k][g];
    for (std::size_t g = 0; g < kG; ++g) x[i][g] *= lower[i * kMostFeatures + i][g];
  }
  for (std::size_t i = count; i-- > 0;) {
    for (std::size_t k = i + 1; k < count; ++k)
      for (std::size_t g = 0; g < kG; ++g) x[i][g] -= lower[k * kMostFeatures + i][g] * x[k][g];
    for (std::size_t g = 0; g < kG; ++g) {
      x[i][g] *= lower[i * kMostFeatures + i][g];
      weights[i * kG + g] = x[i][g];
    }
  }
}

}  // namespace dance
