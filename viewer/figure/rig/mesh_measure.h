// MeshMeasure: measures a model's mesh at rest: how high it is, and its head above the neck, where
// the soles of its feet are, how long its hands are.
//
// Units/frames: metres in M, the model at rest.
// Ownership:    refers to the model and the shape for as long as it lives.
// Threads:      none inside.
// Failure:      none: what has no mesh is estimated from the bones.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "viewer/figure/rig/avatar_shape.h"

namespace dance {

class MeshMeasure {
 public:
  MeshMeasure(const AvatarModel& model, const std::vector<Eigen::Affine3f>& M_from_node,
              const AvatarShape& shape);

  float height_m() const { return height_m_; }
  // From the head's joint up to the highest of what moves with it.
  float crown_m() const;
  SoleShape sole(std::size_t side) const;
  SoleHull hull(std::size_t side) const;  // empty without a mesh
  // Where the middle finger begins; without fingers half way from the wrist to the mesh's end.
  Eigen::Vector3f hand_end(std::size_t side) const;

 private:
  bool belongs(const AvatarVertex& vertex, std::size_t first, std::size_t last) const;

  const AvatarModel& model_;
  const AvatarShape& shape_;
  std::vector<Eigen::Vector3f> places_M_m_;  // of each vertex
  float height_m_ = 1.7f;
};

}  // namespace dance
