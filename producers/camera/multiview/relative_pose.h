// RelativePose: where a second camera stands beside the first, and how its stamps differ, as far as
// rays tell: without a scale.
//
// Units/frames: A the first camera's frame, B the second's (producers/camera/pinhole.h):
//               p_B = R_BA p_A + baseline · p_BA. Seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none.
// Source:       Hartley and Zisserman, Multiple View Geometry, 2004, chapter 9.
#pragma once

#include <Eigen/Geometry>

namespace dance {

struct RelativePose {
  Eigen::Matrix3d R_BA = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_BA = Eigen::Vector3d::UnitX();  // length 1
  double later_s = 0.0;                             // B's stamp of a moment less A's

  // What a step of the six numbers makes of it: a turn of B (3), of the baseline (2), of the
  // stamps.
  using Step = Eigen::Matrix<double, 6, 1>;
  RelativePose moved(const Step& step) const;
  // The two ways in which the baseline can turn, columns.
  Eigen::Matrix<double, 3, 2> ways_of_baseline() const;
};

// Where a point lies that both cameras see, in A, in baselines; and the variance of its place, a
// sum over the three axes, where rays have the given standard deviations. False where the rays do
// not meet before both cameras.
struct MetPoint {
  Eigen::Vector3d p_A;
  double variance = 0.0;
};
bool meet(const RelativePose& pose, const Eigen::Vector2d& ray_A, const Eigen::Vector2d& ray_B,
          double sd_A, double sd_B, MetPoint& out);

}  // namespace dance
