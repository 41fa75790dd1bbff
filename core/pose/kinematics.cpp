#include "core/pose/kinematics.h"

#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Quaternionf;
using Eigen::Vector3f;

void forward_kinematics(const Skeleton& skeleton, const Pose& pose, BodyFrames& frames) {
  frames.p_WB_m[0] = pose.p_WH_m;
  frames.R_WB[0] = pose.R_PB[0];
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const auto parent = static_cast<std::size_t>(kBones[b].parent);
    frames.p_WB_m[b] = frames.p_WB_m[parent] + frames.R_WB[parent] * skeleton.offset_m[b];
    frames.R_WB[b] = frames.R_WB[parent] * pose.R_PB[b];
  }
  for (std::size_t t = 0; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    frames.p_WT_m[t] = frames.p_WB_m[b] + frames.R_WB[b] * skeleton.tip_m[t];
  }
}

namespace {

// Below this a bone has no direction.
constexpr float kShortestBone_m = 1e-3f;

// The rotation whose first column is along x and whose third is normal, which is at right angles to
// x.
Quaternionf frame_along(const Vector3f& x, const Vector3f& normal) {
  Eigen::Matrix3f m;
  m.col(0) = x.normalized();
  m.col(2) = normal;
  m.col(1) = normal.cross(m.col(0));
  return Quaternionf(m);
}

// The normal of the plane that a bone of the T-pose bends in, when it bends towards pole.
Vector3f bend_normal(const Vector3f& bone, const Vector3f& pole) {
  const Vector3f normal = bone.cross(pole);
  return normal.squaredNorm() > 1e-12f ? Vector3f(normal.normalized())
                                       : Vector3f(bone.unitOrthogonal());
}

}  // namespace

float solve_two_bone(const Skeleton& skeleton, const Limb& limb, const Vector3f& target_W_m,
                     const Vector3f& pole_W, const Quaternionf& R_WEnd, Pose& pose,
                     BodyFrames& frames) {
  const std::size_t upper = index_of(limb.upper);
  const std::size_t lower = index_of(limb.lower);
  const std::size_t end = index_of(limb.end);
  const Vector3f& offset_lower = skeleton.offset_m[lower];
  const Vector3f& offset_end = skeleton.offset_m[end];
  const float a = offset_lower.norm();
  const float b = offset_end.norm();
  const Vector3f p_upper = frames.p_WB_m[upper];
  if (a < kShortestBone_m || b < kShortestBone_m) return (target_W_m - frames.p_WB_m[end]).norm();

  const Vector3f to_target = target_W_m - p_upper;
  const float distance = to_target.norm();
  const float reach = std::clamp(distance, std::abs(a - b) + 1e-4f, a + b - 1e-4f);
  const Vector3f along = distance > 1e-6f ? Vector3f(to_target / distance) : Vector3f(0, -1, 0);
  Vector3f side = pole_W - along * along.dot(pole_W);
  if (side.squaredNorm() < 1e-10f) side = along.unitOrthogonal();
  side.normalize();

  // Law of cosines: the middle joint lies at `x` along the line and `y` beside it.
  const float x = (a * a - b * b + reach * reach) / (2.0f * reach);
  const float y = std::sqrt(std::max(0.0f, a * a - x * x));
  const Vector3f p_lower = p_upper + along * x + side * y;
  const Vector3f p_end = p_upper + along * reach;

  // The plane of the limb in T-pose: the bend axis seen from the bone. An arm's elbow bends forward
  // about the bone's own vertical, a knee backward; both follow from the pole when the plane in
  // T-pose is taken through the same pole.
  const Vector3f rest_pole = limb.upper == Bone::kLeftUpperArm || limb.upper == Bone::kRightUpperArm
                                 ? Vector3f(0, 0, -1)
                                 : Vector3f(0, 0, 1);
  // The plane's normal is the same for both bones, however far the limb is bent; computed from each
  // bone and the pole it would twist the forearm by half a turn when the hand is close to the
  // shoulder.
  const Vector3f normal = along.cross(side);
  const auto aim = [&](const Vector3f& rest, const Vector3f& direction) {
    return frame_along(direction, normal) *
           frame_along(rest, bend_normal(rest, rest_pole)).conjugate();
  };
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  const Quaternionf R_WU = aim(offset_lower, p_lower - p_upper);
  const Quaternionf R_WL = aim(offset_end, p_end - p_lower);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * R_WU).normalized();
  pose.R_PB[lower] = (R_WU.conjugate() * R_WL).normalized();
  pose.R_PB[end] = (R_WL.conjugate() * R_WEnd).normalized();
  frames.R_WB[upper] = R_WU;
  frames.R_WB[lower] = R_WL;
  frames.R_WB[end] = R_WEnd;
  frames.p_WB_m[lower] = p_lower;
  frames.p_WB_m[end] = p_end;
  return std::abs(distance - reach) < 2e-4f ? 0.0f : std::abs(distance - reach);
}

}  // namespace dance
