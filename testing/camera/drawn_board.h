// A chessboard drawn as a camera sees it, through its lens, with exact truth: for judging a
// calibration.
//
// Units/frames: metres and pixels; B is the board's frame: its first inner corner at the origin, x
//               along the columns, z away.
// Ownership:    a painter keeps its lens's rays.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "producers/camera/stereo/chessboard.h"
#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

struct BoardPlace {
  Eigen::Matrix3d R_CB;
  Eigen::Vector3d p_CB_m;
};

// Ways of holding the board before a camera of this kind that show its picture's corners, edges and
// depth, and lean each way.
std::vector<BoardPlace> ways_to_hold(const Pinhole& camera, const BoardShape& shape);

BoardPlace in_right_eye(const StereoRig& rig, const BoardPlace& left);

class DrawnBoardPainter {
 public:
  explicit DrawnBoardPainter(const Pinhole& camera);
  cv::Mat draw(const BoardShape& shape, const BoardPlace& place, std::uint64_t seed) const;

 private:
  Pinhole camera_;
  std::vector<Eigen::Vector2d> corner_rays_;  // of the pixels' corners, row by row
};

}  // namespace dance
