// A product of matrices that is fast enough to train with, on whatever vectors the processor has,
// and gives the same bits on all of them.
//
// Units/frames: none.
// Ownership:    none; never allocates. Arrays do not overlap.
// Threads:      any.
// Failure:      none.
#pragma once

#include <cstddef>

namespace dance {

// c[i][j] += sum over k of a[i * a_row + k * a_column] * b[k][j]; c is rows x columns, b inner x
// columns, both by rows.
void add_matrix_product(const float* a, std::size_t a_row, std::size_t a_column, const float* b,
                        std::size_t b_row, float* c, std::size_t rows, std::size_t inner,
                        std::size_t columns);

}  // namespace dance
