#include "producers/camera/multiview/relative_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Eigen::Matrix<double, 3, 2> RelativePose::ways_of_baseline() const {
  Eigen::Matrix<double, 3, 2> ways;
  ways.col(0) = p_BA.unitOrthogonal();
  ways.col(1) = p_BA.cross(ways.col(0));
  return ways;
}

RelativePose RelativePose::moved(const Step& step) const {
  RelativePose moved = *this;
  const Vector3d turn = step.head<3>();
  if (turn.norm() > 1e-12)
    moved.R_BA = Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()) * R_BA)
                     .normalized()
                     .toRotationMatrix();
  moved.p_BA = (p_BA + ways_of_baseline() * step.segment<2>(3)).normalized();
  moved.later_s += step[5];
  return moved;
}

bool meet(const RelativePose& pose, const Vector2d& ray_A, const Vector2d& ray_B, double sd_A,
          double sd_B, MetPoint& out) {
  Matrix3d information;
  Vector3d p = Vector3d::Zero();
  // The second time each ray counts by the depth that the first gave.
  double depth_A = 1.0, depth_B = 1.0;
  for (int round = 0; round < 2; ++round) {
    information.setZero();
    Vector3d sum = Vector3d::Zero();
    const auto add = [&](const Vector3d& row, double value, double sd) {
      information += row * row.transpose() / (sd * sd);
      sum += row * value / (sd * sd);
    };
    for (int axis = 0; axis < 2; ++axis) {
      const Vector3d row_A = Vector3d::Unit(axis) - ray_A[axis] * Vector3d::UnitZ();
      add(row_A, 0.0, sd_A * depth_A);
      const Vector3d row_B = (pose.R_BA.row(axis) - ray_B[axis] * pose.R_BA.row(2)).transpose();
      add(row_B, ray_B[axis] * pose.p_BA.z() - pose.p_BA[axis], sd_B * depth_B);
    }
    p = information.ldlt().solve(sum);
    depth_A = p.z();
    depth_B = pose.R_BA.row(2).dot(p) + pose.p_BA.z();
    if (!p.allFinite() || !(depth_A > 0.05) || !(depth_B > 0.05)) return false;
  }
  out.p_A = p;
  out.variance = information.inverse().trace();
  return std::isfinite(out.variance);
}

}  // namespace dance
