// The surface of a layer: its parts grown together into one closed, smooth skin, as triangles.
//
// Units/frames: metres in the parts' frame; triangles are counter-clockwise from outside.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a layer without parts has no triangles. A cell is made larger where a body of
//               extreme proportions would need more than kMostSamples.
// Source:       Gibson, Constrained Elastic Surface Nets (1998): one vertex in each cell of a grid
//               that the surface passes through; here put onto the surface by Newton's steps.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "formats/body/figure_part.h"

namespace dance {

struct Surface {
  std::vector<Eigen::Vector3f> places_m;
  std::vector<Eigen::Vector3f> normals;  // unit, outwards
  std::vector<std::uint32_t> triangles;  // three vertices each
};

constexpr std::size_t kMostSamples = 400'000;

Surface surface_of(const FigureLayer& layer);

// Below 0 inside; near the surface the distance to it, where parts are round.
float signed_distance_m(const FigureLayer& layer, const Eigen::Vector3f& place_m);

// signed_distance_m() for many places: prepares the layer's parts once.
class LayerDistance {
 public:
  explicit LayerDistance(const FigureLayer& layer);
  ~LayerDistance();
  float at(const Eigen::Vector3f& place_m) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace dance
