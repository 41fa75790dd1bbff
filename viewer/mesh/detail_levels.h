// The same triangles in fewer and fewer, for figures that are small in the picture. Vertices are
// chosen and never moved, so that uv, normal and skin stay what the model's maker gave them; and
// where a figure bends vertices are kept, although it is straight at rest.
//
// Units/frames: metres.
// Ownership:    plain values; borrows for the call.
// Threads:      none inside.
// Failure:      none; a level that cannot be made simpler is left out.
// Source:       Garland and Heckbert, Surface Simplification Using Quadric Error Metrics (1997), as
//               meshoptimizer has it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace dance {

struct DetailVertex {
  Eigen::Vector3f place_m;
  Eigen::Vector3f normal;
  float bend = 0.0f;  // 0: follows one joint, 1: two or more alike
  float face = 0.0f;  // 1: part of the head, which keeps more triangles
};

// Triangles of each batch, as indices of vertices.
using BatchTriangles = std::vector<std::vector<std::uint32_t>>;

// From fine to coarse; the first is `fine` itself, in an order that is quick to draw.
std::vector<BatchTriangles> detail_levels(std::span<const DetailVertex> vertices,
                                          const BatchTriangles& fine);

}  // namespace dance
