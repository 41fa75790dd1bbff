// Places and rotations of a BVH's joints in its own world, frame by frame, from its offsets and
// channels.
//
// Units/frames: the file's units and axes F; R_FJ is a joint's rotation in F.
// Ownership:    keeps a reference to the Bvh, which must outlive it.
// Threads:      none inside; const use from any.
// Failure:      a frame index out of range is our bug.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "formats/bvh/bvh.h"

namespace dance {

struct BvhFigure {
  std::vector<Eigen::Vector3d> p_FJ;
  std::vector<Eigen::Quaterniond> R_FJ;

  // Where a joint's bone ends: at its End Site, or at its only child where that is the last joint
  // (some tools write ends as joints); the joint's own place where it has neither.
  Eigen::Vector3d end_of(const Bvh& bvh, std::size_t joint) const;
};

class BvhMotion {
 public:
  explicit BvhMotion(const Bvh& bvh);

  void figure_at(std::size_t frame, BvhFigure& figure) const;
  // The figure with no joint turned: from the OFFSETs alone. Places of joints that have position
  // channels are those of the first frame.
  void zero_figure(BvhFigure& figure) const;
  // True where position channels of joints other than the root are added to OFFSETs; tools differ.

  const Bvh& bvh() const { return bvh_; }

 private:
  Eigen::Vector3d local_position(std::size_t joint, const float* values) const;
  Eigen::Quaterniond local_rotation(std::size_t joint, const float* values) const;
  bool positions_look_added() const;

  const Bvh& bvh_;
  bool adds_positions_ = false;
};

}  // namespace dance
