#include "research/matrix_product.h"

#include <cstring>

#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

constexpr std::size_t kWide = 32, kHigh = 4;

}  // namespace

DANCE_WIDE_VECTORS void add_matrix_product(const float* __restrict a, std::size_t a_row,
                                           std::size_t a_column, const float* __restrict b,
                                           std::size_t b_row, float* __restrict c, std::size_t rows,
                                           std::size_t inner, std::size_t columns) {
  // A tile of kHigh x kWide sums stays in registers while the inner index runs.
  typedef float Vector __attribute__((vector_size(64)));
  std::size_t j = 0;
  for (; j + kWide <= columns; j += kWide) {
    std::size_t i = 0;
    for (; i + kHigh <= rows; i += kHigh) {
      Vector s00{}, s01{}, s10{}, s11{}, s20{}, s21{}, s30{}, s31{};
      for (std::size_t k = 0; k < inner; ++k) {
        Vector b0, b1;
        std::memcpy(&b0, b + k * b_row + j, sizeof b0);
        std::memcpy(&b1, b + k * b_row + j + 16, sizeof b1);
        const float* at = a + i * a_row + k * a_column;
        const float a0 = at[0], a1 = at[a_row], a2 = at[2 * a_row], a3 = at[3 * a_row];
        s00 += a0 * b0, s01 += a0 * b1;
        s10 += a1 * b0, s11 += a1 * b1;
        s20 += a2 * b0, s21 += a2 * b1;
        s30 += a3 * b0, s31 += a3 * b1;
      }
      const Vector* sums[kHigh][2] = {{&s00, &s01}, {&s10, &s11}, {&s20, &s21}, {&s30, &s31}};
      for (std::size_t r = 0; r < kHigh; ++r)
        for (std::size_t half = 0; half < 2; ++half)
          for (std::size_t l = 0; l < 16; ++l)
            c[(i + r) * columns + j + 16 * half + l] += (*sums[r][half])[l];
    }
    for (; i < rows; ++i)
      for (std::size_t k = 0; k < inner; ++k)
        for (std::size_t l = 0; l < kWide; ++l)
          c[i * columns + j + l] += a[i * a_row + k * a_column] * b[k * b_row + j + l];
  }
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < inner; ++k)
      for (std::size_t l = j; l < columns; ++l)
        c[i * columns + l] += a[i * a_row + k * a_column] * b[k * b_row + l];
}

}  // namespace dance
