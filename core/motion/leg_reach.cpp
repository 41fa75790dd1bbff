#include "core/motion/leg_reach.h"

#include <algorithm>
#include <cmath>

#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// A leg is not straightened further than this: the knee angle becomes ill-conditioned.
constexpr float kStraightest = 0.996f;
// A nearly straight knee bends forward.
constexpr float kForward_m = 0.005f;
constexpr float kMostDrop_m = 0.4f;

float leg_length_m(const Skeleton& skeleton, const Limb& leg) {
  return skeleton.offset(leg.lower).norm() + skeleton.offset(leg.end).norm();
}

Quaternionf turned_short(const Vector3f& from, const Vector3f& to, const Quaternionf& R) {
  return shortest_turn(from.cast<double>(), to.cast<double>()).cast<float>() * R;
}

}  // namespace

float needed_drop_m(const Skeleton& skeleton, const BodyFrames& like,
                    const std::array<Vector3f, 2>& hip_joints_W_m,
                    const std::array<Vector3f, 2>& ankles_W_m,
                    const std::array<float, 2>& carries) {
  float drop = 0.0f;
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = side == 0 ? kLeftLeg : kRightLeg;
    const float length = leg_length_m(skeleton, leg);
    const float was = std::min((like.position(leg.upper) - like.position(leg.end)).norm(), length);
    const float reach = std::max(was, kStraightest * length);
    const Vector3f up = hip_joints_W_m[side] - ankles_W_m[side];
    const float aside2 = up.x() * up.x() + up.z() * up.z();
    const float highest = std::sqrt(std::max(0.0f, reach * reach - aside2));
    drop = std::max(drop, carries[side] * (up.y() - highest));
  }
  return std::min(drop, kMostDrop_m);
}

float reach_ankle(const Skeleton& skeleton, const Limb& leg, const BodyFrames& like,
                  const Vector3f& target_W_m, const Quaternionf& R_WFoot, Pose& pose,
                  BodyFrames& frames) {
  const std::size_t upper = index_of(leg.upper), lower = index_of(leg.lower),
                    end = index_of(leg.end);
  const Vector3f hip_was = like.p_WB_m[upper], knee_was = like.p_WB_m[lower],
                 ankle_was = like.p_WB_m[end];
  const float thigh = skeleton.offset_m[lower].norm(), shank = skeleton.offset_m[end].norm();
  const Vector3f hip = frames.p_WB_m[upper];
  Vector3f along = target_W_m - hip;
  const float wanted = along.norm();
  if (thigh < 1e-3f || shank < 1e-3f || wanted < 1e-3f) return 0.0f;
  along /= wanted;
  const float was = (ankle_was - hip_was).norm();
  const float most = std::max(std::min(was, thigh + shank), kStraightest * (thigh + shank));
  const float least = std::min(most, 1.05f * std::abs(thigh - shank) + 1e-3f);
  const float distance = std::clamp(wanted, least, most);

  const Vector3f along_was = (ankle_was - hip_was).normalized();
  Vector3f bend = knee_was - hip_was + kForward_m * (like.R_WB[upper] * Vector3f::UnitZ());
  bend -= along_was * along_was.dot(bend);
  bend -= along * along.dot(bend);
  // A straight or hyperextended knee bends forward.
  Vector3f forward = like.R_WB[upper] * Vector3f::UnitZ();
  forward -= along * along.dot(forward);
  if (const float size = forward.norm(); size > 1e-3f) {
    forward /= size;
    bend += std::max(0.0f, kForward_m - forward.dot(bend)) * forward;
  }
  if (bend.squaredNorm() < 1e-12f) bend = along.unitOrthogonal();
  bend.normalize();
  // Law of cosines at the hip.
  const float cosine =
      std::clamp((thigh * thigh + distance * distance - shank * shank) / (2.0f * thigh * distance),
                 -1.0f, 1.0f);
  const Vector3f knee = hip + thigh * (cosine * along + std::sqrt(1.0f - cosine * cosine) * bend);
  const Vector3f ankle = hip + distance * along;

  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  const Quaternionf R_WU = turned_short(knee_was - hip_was, knee - hip, like.R_WB[upper]);
  const Quaternionf R_WL = turned_short(ankle_was - knee_was, ankle - knee, like.R_WB[lower]);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * R_WU).normalized();
  pose.R_PB[lower] = (R_WU.conjugate() * R_WL).normalized();
  pose.R_PB[end] = (R_WL.conjugate() * R_WFoot).normalized();
  frames.R_WB[upper] = R_WU;
  frames.R_WB[lower] = R_WL;
  frames.R_WB[end] = R_WFoot;
  frames.p_WB_m[lower] = knee;
  frames.p_WB_m[end] = ankle;
  return std::abs(wanted - distance);
}

}  // namespace dance
