// A layer of a figure as a sheet with fewer triangles, chosen where joints bend: the surface is
// simplified as it lies with elbows, knees, hips and fingers bent, so that edges stay where they
// are needed. Vertices that stay keep place, normal and joints.
//
// Units/frames: as Sheet.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; the surface stays closed, and may keep more triangles than asked for.
// Source:       meshoptimizer; linear blend skinning.
#pragma once

#include "core/pose/skeleton.h"
#include "formats/avatar/make/sheet.h"
#include "formats/body/figure_part.h"
#include "formats/body/skin_weights.h"

namespace dance {

class BentFigure {
 public:
  explicit BentFigure(const Skeleton& skeleton);

  // The layer's surface with about `most_triangles`.
  Sheet build_sheet(const FigureLayer& layer, std::size_t most_triangles) const;

 private:
  std::vector<Eigen::Vector3f> bent(const Sheet& sheet) const;

  SkinWeighting weighting_;
  std::vector<Eigen::Affine3f> bend_;  // of each joint, from T-pose
};

}  // namespace dance
