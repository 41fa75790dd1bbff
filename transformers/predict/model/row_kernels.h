// The loops that prediction spends its time in, on plain arrays: each is compiled for processors
// with and without wide vectors, and the program takes what the machine has. All give the same bits
// everywhere: sums run in one order, and never inside a vector.
//
// Units/frames: the caller's. Arrays do not overlap.
// Ownership:    none; never allocate.
// Threads:      any.
// Failure:      none.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(DANCE_SANITIZED)
#define DANCE_WIDE_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define DANCE_WIDE_VECTORS
#endif

namespace dance {

// y[j] += sum over i of x[i] * matrix[i * columns + j]; an x of 0 costs nothing.
void add_product(const float* x, std::size_t rows, const float* matrix, std::size_t columns,
                 float* y);

// As add_product() of x and of z, which read the matrix once.
void add_two_products(const float* x, const float* z, std::size_t rows, const float* matrix,
                      std::size_t columns, float* y, float* w);

// y[j] += a * x[j]
void add_scaled(float a, const float* x, std::size_t count, float* y);

// sum[j] += weight * (to[j] - from[j])
void add_difference(float weight, const float* from, const float* to, std::size_t count,
                    float* sum);

// Groups of three numbers, group fastest: way = sum over e of weights[e * groups + group] *
// rows[e].
void weigh_rows(const float* const* rows, std::size_t count, const float* weights, float* way);

// distances[l] = keep * distances[l] + sum over d of (now[d] - past[d * stride + l])², for l <
// lags.
void follow_distances(const float* now, std::size_t dimensions, const float* past,
                      std::size_t stride, std::size_t lags, float* distances, float keep_a,
                      float* distances_b, float keep_b);

// is_least[i] = 1 where no neighbour of x[i] is smaller, else 0; for 0 < i < count - 1.
void find_least(const float* x, std::size_t count, std::uint8_t* is_least);

// Groups of three numbers, group fastest: pairs[p * groups + g] = keep * pairs[...] + sum over axes
// of counts[g] * features[e] * features[f] for every e <= f, and targets[e * groups + g] likewise
// with y.
void follow_gram(const float* const* features, std::size_t count, const float* y,
                 const float* counts, float keep, float* pairs, float* targets);

// For each of 24 groups: (G + diag(G) * ridge) w = c + diag(G) * ridge * prior, by Cholesky; G
// packed as above. Where G has no size, w becomes the prior.
void solve_groups(const float* pairs, const float* targets, std::size_t count, float ridge,
                  const float* prior, float* weights);

}  // namespace dance
