// BodyModel: forward kinematics of a body's points, and their Jacobian.
//
// Units/frames: metres in W; columns of a Jacobian are the degrees of freedom of body_state.h.
// Ownership:    keeps its numbers (about 50 KB); never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/body_state.h"

namespace dance {

using PointJacobian = Eigen::Matrix<double, 3, dof::kCount>;

class BodyModel {
 public:
  BodyModel();

  void place(const BodyShape& shape, const BodyState& state);
  // Of what place() placed.
  void differentiate();

  const Eigen::Vector3d& point(std::size_t i) const { return point_W_m_[i]; }
  const Eigen::Vector3d& point(Landmark l) const { return point_W_m_[point_of(l)]; }
  const PointJacobian& jacobian(std::size_t i) const { return jacobian_[i]; }
  // Bit d: the point depends on the d-th degree of freedom.
  std::uint64_t moved_by(std::size_t i) const { return moved_by_[i]; }

  const Eigen::Vector3d& origin(Bone bone) const { return p_WB_m_[index_of(bone)]; }
  const Eigen::Matrix3d& rotation(Bone bone) const { return R_WB_[index_of(bone)]; }

 private:
  // An axis of a degree of freedom; several where bones share it.
  struct Axis {
    int dof;
    std::size_t bone;
    double share;
    Eigen::Vector3d axis_W;
  };
  static constexpr std::size_t kAxisCount = 52;

  void list_axes();
  void place_side(const BodyState::Side& side, std::size_t s);
  void set_axes(std::size_t first, std::size_t count, const Eigen::Matrix3d& R);

  std::array<Eigen::Vector3d, kBoneCount> p_WB_m_;
  std::array<Eigen::Matrix3d, kBoneCount> R_WB_;
  std::array<Eigen::Vector3d, kBoneCount> offset_m_;
  std::array<Eigen::Vector3d, kBodyPointCount> point_W_m_;
  std::array<PointJacobian, kBodyPointCount> jacobian_;
  std::array<std::uint64_t, kBodyPointCount> moved_by_{};
  std::array<Axis, kAxisCount> axes_;
  std::array<std::uint64_t, kBoneCount> axes_of_bone_{};  // bits: those of it and its ancestors
};

}  // namespace dance
