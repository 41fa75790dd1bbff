#include "producers/camera/solver/body_model.h"

#include <bit>

#include "core/base/assert.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d matrix_about(const Vector3d& axis, double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
}

std::size_t arm_of(std::size_t s) {
  return index_of(s == 0 ? Bone::kLeftShoulder : Bone::kRightShoulder);
}
std::size_t leg_of(std::size_t s) {
  return index_of(s == 0 ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg);
}

// Where the axes of the parts begin in the list.
constexpr std::size_t kHipsAxes = 0, kSpineAxes = 3, kHeadAxes = 12, kSideAxes = 18,
                      kAxesOfSide = 17;

}  // namespace

BodyModel::BodyModel() {
  list_axes();
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    if (b > 0) axes_of_bone_[b] = axes_of_bone_[static_cast<std::size_t>(kBones[b].parent)];
    for (std::size_t a = 0; a < kAxisCount; ++a)
      if (axes_[a].bone == b) axes_of_bone_[b] |= std::uint64_t{1} << a;
  }
  for (std::size_t i = 0; i < kBodyPointCount; ++i) {
    jacobian_[i].setZero();
    jacobian_[i].block<3, 3>(0, dof::kPlace).setIdentity();
    moved_by_[i] = 7u << dof::kPlace;
    std::uint64_t axes = axes_of_bone_[index_of(bone_of(i))];
    for (; axes != 0; axes &= axes - 1)
      moved_by_[i] |= std::uint64_t{1}
                      << axes_[static_cast<std::size_t>(std::countr_zero(axes))].dof;
  }
}

void BodyModel::list_axes() {
  std::size_t at = 0;
  const auto add = [&](int dof, std::size_t bone, int count, double share) {
    for (int i = 0; i < count; ++i) axes_[at++] = {dof + i, bone, share, Vector3d::Zero()};
  };
  add(dof::kHips, 0, 3, 1.0);
  for (std::size_t bone = 1; bone <= 3; ++bone) add(dof::kSpine, bone, 3, 1.0 / 3.0);
  for (std::size_t bone = 4; bone <= 5; ++bone) add(dof::kHead, bone, 3, 0.5);
  for (std::size_t s = 0; s < 2; ++s) {
    const int first = dof::side(static_cast<int>(s));
    const std::size_t arm = arm_of(s), leg = leg_of(s);
    add(first + dof::kShoulder, arm, 2, 1.0);
    add(first + dof::kUpperArm, arm + 1, 3, 1.0);
    add(first + dof::kElbow, arm + 2, 1, 1.0);
    add(first + dof::kTurn, arm + 2, 1, 0.5);
    add(first + dof::kTurn, arm + 3, 1, 0.5);
    add(first + dof::kHand, arm + 3, 2, 1.0);
    add(first + dof::kUpperLeg, leg, 3, 1.0);
    add(first + dof::kKnee, leg + 1, 1, 1.0);
    add(first + dof::kFoot, leg + 2, 3, 1.0);
  }
  DANCE_ASSERT(at == kAxisCount, at);
}

void BodyModel::set_axes(std::size_t first, std::size_t count, const Matrix3d& R) {
  for (std::size_t i = 0; i < count; ++i)
    axes_[first + i].axis_W = R.col(static_cast<Eigen::Index>(i));
}

void BodyModel::place_side(const BodyState::Side& side, std::size_t s) {
  const double sign = s == 0 ? 1.0 : -1.0;
  const std::size_t arm = arm_of(s), leg = leg_of(s);
  std::size_t at = kSideAxes + s * kAxesOfSide;
  const auto turn_bone = [this](std::size_t bone, const Matrix3d& R_PB) -> const Matrix3d& {
    const auto parent = static_cast<std::size_t>(kBones[bone].parent);
    p_WB_m_[bone] = p_WB_m_[parent] + R_WB_[parent] * offset_m_[bone];
    R_WB_[bone].noalias() = R_WB_[parent] * R_PB;
    return R_WB_[bone];
  };
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  axes_[at].axis_W = sign * R_WB_[index_of(Bone::kUpperChest)].col(2);
  const Matrix3d& R_shoulder = turn_bone(arm, matrix_about(z, sign * side.shoulder_up) *
                                                  matrix_about(y, -sign * side.shoulder_forward));
  axes_[at + 1].axis_W = -sign * R_shoulder.col(1);
  const Matrix3d& R_arm = turn_bone(arm + 1, side.upper_arm.toRotationMatrix());
  set_axes(at + 2, 3, R_arm);
  axes_[at + 5].axis_W = -sign * R_arm.col(1);
  const Matrix3d half = matrix_about(x, 0.5 * side.turn);
  const Matrix3d& R_fore = turn_bone(arm + 2, matrix_about(y, -sign * side.elbow) * half);
  axes_[at + 6].axis_W = axes_[at + 7].axis_W = R_fore.col(0);
  const Matrix3d R_turned = R_fore * half;
  axes_[at + 8].axis_W = sign * R_turned.col(2);
  const Matrix3d& R_hand = turn_bone(arm + 3, half * matrix_about(z, sign * side.hand_up) *
                                                  matrix_about(y, -sign * side.hand_forward));
  axes_[at + 9].axis_W = -sign * R_hand.col(1);
  const Matrix3d& R_thigh = turn_bone(leg, side.upper_leg.toRotationMatrix());
  set_axes(at + 10, 3, R_thigh);
  axes_[at + 13].axis_W = R_thigh.col(0);
  turn_bone(leg + 1, matrix_about(x, side.knee));
  set_axes(at + 14, 3, turn_bone(leg + 2, side.foot.toRotationMatrix()));
  turn_bone(leg + 3, Matrix3d::Identity());
}

void BodyModel::place(const BodyShape& shape, const BodyState& state) {
  for (std::size_t b = 0; b < kBoneCount; ++b)
    offset_m_[b] = shape.skeleton.offset_m[b].cast<double>();
  p_WB_m_[0] = state.p_WH_m;
  R_WB_[0] = state.R_WH.toRotationMatrix();
  set_axes(kHipsAxes, 3, R_WB_[0]);
  // A bone's share of a rotation vector turns about axes that are half way into the bone's own
  // turn.
  const auto bend = [this](std::size_t first, std::size_t count, std::size_t axes,
                           const Vector3d& whole) {
    const Vector3d share = whole / static_cast<double>(count);
    const Matrix3d R = turn_of(share).toRotationMatrix(),
                   R_half = turn_of(0.5 * share).toRotationMatrix();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t bone = first + i;
      p_WB_m_[bone] = p_WB_m_[bone - 1] + R_WB_[bone - 1] * offset_m_[bone];
      set_axes(axes + 3 * i, 3, R_WB_[bone - 1] * R_half);
      R_WB_[bone].noalias() = R_WB_[bone - 1] * R;
    }
  };
  bend(1, 3, kSpineAxes, state.spine);
  bend(4, 2, kHeadAxes, state.head);
  for (std::size_t s = 0; s < 2; ++s) place_side(state.sides[s], s);
  for (std::size_t i = 0; i < kBodyPointCount; ++i) {
    const std::size_t bone = index_of(bone_of(i));
    point_W_m_[i] = p_WB_m_[bone] + R_WB_[bone] * shape.point_m[i];
  }
}

void BodyModel::differentiate() {
  for (std::size_t i = 0; i < kBodyPointCount; ++i) {
    PointJacobian& J = jacobian_[i];
    std::uint64_t moved = moved_by_[i] & ~(std::uint64_t{7} << dof::kPlace);
    for (; moved != 0; moved &= moved - 1) J.col(std::countr_zero(moved)).setZero();
    std::uint64_t axes = axes_of_bone_[index_of(bone_of(i))];
    for (; axes != 0; axes &= axes - 1) {
      const Axis& axis = axes_[static_cast<std::size_t>(std::countr_zero(axes))];
      // dp = share · ω × (p − o)
      J.col(axis.dof) += axis.share * axis.axis_W.cross(point_W_m_[i] - p_WB_m_[axis.bone]);
    }
  }
}

}  // namespace dance
