// Places and rotations of a BVH's joints in its own world, frame by frame, from its offsets and
// channels.
//
// Units/frames: the file's units and axes F; R_FJ is a joint's rotation in F.
// Ownership:    keeps a reference to the Bvh, which must outlive it.
// Threads:      none inside; const use from any.
// Failure:      a frame index out of range is our bug.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "formats/bvh/bvh.h"

namespace dance {

struct BvhFigure {
  std::vector<Eigen::Vector3d> p_FJ;
  std::vector<Eigen::Quaterniond> R_FJ;

  // Where a joint's bone ends: at its End Site, or at its only child where that is the last joint
  // (some tools write ends as joints); the joint's own place where it has neither.
  Eigen::Vector3d end_of(const Bvh& bvh, std::size_t joint) const;
  // The place below a joint that is furthest from it: joints and End Sites of its whole branch.
  Eigen::Vector3d far_end_of(const Bvh& bvh, std::size_t joint) const;
};

// Tools differ in what the position channels of inner joints hold.
enum class BvhPositions : std::uint8_t { kReplaceOffsets, kAddToOffsets };

class BvhMotion {
 public:
  // Reads positions the way that keeps joints nearest to their OFFSETs over all frames.
  explicit BvhMotion(const Bvh& bvh);
  BvhMotion(const Bvh& bvh, BvhPositions positions)
      : bvh_(bvh), adds_positions_(positions == BvhPositions::kAddToOffsets) {}

  void figure_at(std::size_t frame, BvhFigure& figure) const;
  // The figure with no joint turned: from the OFFSETs alone. Places of joints that have position
  // channels are those of the first frame.
  void zero_figure(BvhFigure& figure) const;

  const Bvh& bvh() const { return bvh_; }

 private:
  Eigen::Vector3d local_position(std::size_t joint, const float* values) const;
  Eigen::Quaterniond local_rotation(std::size_t joint, const float* values) const;

  const Bvh& bvh_;
  bool adds_positions_ = false;
};

// Number of frames, evenly spread, from which properties of a whole take are estimated.
constexpr std::size_t kSampledFrames = 64;
inline std::size_t sample_step(const Bvh& bvh) {
  return std::max<std::size_t>(1, bvh.frame_count / kSampledFrames);
}

// How far position channels are from the OFFSETs and from zero, summed over the sampled
// frames and over the joints that `counts` selects (all but the root where it is empty).
struct BvhPositionDistance {
  double from_offset = 0.0;
  double from_zero = 0.0;
  bool looks_added() const { return from_zero < from_offset; }
};
BvhPositionDistance position_distance(const Bvh& bvh, const std::vector<bool>& counts = {});

}  // namespace dance
