// How a captured figure stands: which way its trunk, limbs and sides point, whether it stands
// upright at all, and how tall it is. From joint places alone, so in any units and axes.
//
// Units/frames: of the file's world F.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; directions of a collapsed figure are zero and it does not stand.
#pragma once

#include <Eigen/Geometry>

#include "formats/bvh/bvh_motion.h"
#include "formats/bvh/rig/rig.h"

namespace dance {

struct RigStance {
  Eigen::Vector3d trunk;      // from between the thighs to between the upper arms
  Eigen::Vector3d hips_left;  // from the right thigh to the left
  Eigen::Vector3d chest_left;
  Eigen::Vector3d toes_forward;  // mean direction of the feet; zero where the file has none
  double legs_down = -1.0;       // cosine between the worse leg and the trunk's down
  double straightness = 0.0;     // of the most bent limb, 1 is stretched
  double height = 0.0;           // as it would stand straight

  Eigen::Vector3d up() const { return trunk.normalized(); }
  // A figure upright with its sides where they belong; the better the stance the higher the score.
  bool stands() const;
  double score() const { return legs_down + straightness; }
};

// Mean direction from feet to hips and from hips to head over the whole take; its length is below
// 1 where the dancer does not keep upright.
Eigen::Vector3d mean_up(const BvhMotion& motion, const Rig& rig);

RigStance stance_of(const Bvh& bvh, const Rig& rig, const BvhFigure& figure);

// Where a bone ends: at the next joint of the chain, or at its End Site, or where it begins.
Eigen::Vector3d bone_end(const Bvh& bvh, const BvhFigure& figure, int joint, int next);

// Direction of a foot from its ankle to its toes, or to the far end of its chain if the file has no
// toes or hangs them straight below the ankle. Zero if the foot has no end.
Eigen::Vector3d foot_direction(const Bvh& bvh, const Rig& rig, const BvhFigure& figure,
                               bool is_left);

}  // namespace dance
