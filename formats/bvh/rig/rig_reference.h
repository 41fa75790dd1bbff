// The reference pose of a captured figure: the pose of the file that corresponds to the canonical
// T-pose, bone by bone. Mostly the one with no joint turned; where that is not a standing figure
// (some tools lay every bone along one axis) a frame in which it stands.
//
// Units/frames: F is the file's world with its units, W the stage; C_B is the rotation in W that
//               the canonical bone B has in the reference pose.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      assumptions are reported in `notes`; the caller refuses a file without frames.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "formats/bvh/bvh_motion.h"
#include "formats/bvh/retarget.h"
#include "formats/bvh/rig/rig.h"

namespace dance {

struct RigReference {
  BvhFigure figure;  // in F
  bool is_zero_pose = true;
  bool is_canonical = false;  // in our own T-pose: no bone needs a correction
  Eigen::Quaterniond R_WF = Eigen::Quaterniond::Identity();
  double metres_per_unit = 1.0;
  double height_m = 0.0;
  std::array<Eigen::Quaterniond, kBoneCount> C;
  std::array<Eigen::Quaterniond, kFingerBoneCount> C_finger;

  // A joint's place in the reference pose, W, metres.
  Eigen::Vector3d p_W_m(int joint) const {
    return R_WF * (metres_per_unit * figure.p_FJ[static_cast<std::size_t>(joint)]);
  }
  Eigen::Vector3d end_W_m(const Bvh& bvh, int joint) const {
    return R_WF * (metres_per_unit * figure.end_of(bvh, static_cast<std::size_t>(joint)));
  }
  Eigen::Vector3d far_end_W_m(const Bvh& bvh, int joint) const {
    return R_WF * (metres_per_unit * figure.far_end_of(bvh, static_cast<std::size_t>(joint)));
  }
};

RigReference find_reference(const BvhMotion& motion, const Rig& rig, const RetargetOptions& options,
                            std::vector<std::string>& notes);

}  // namespace dance
