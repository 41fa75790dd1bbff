#include "transformers/touch/hand_reach.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/pose/shortest_turn.h"

namespace dance {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

namespace {

constexpr float kShortestArm_m = 1e-3f;
constexpr float kMostTurn_rad = 3.1f;
// An elbow is not stretched further than this share of the arm's length, unless it was.
constexpr float kStraightArm = 0.998f;

// The plane of an elbow that is bent less than this, 10°, is noise.
constexpr float kPlaneOfElbow = 0.1736f;  // the sine

// The axis about which the elbow opens: that of the plane it is bent in; where it bends from being
// nearly straight, ever more its hinge in T-pose.
Vector3f elbow_hinge(std::size_t side, const Vector3f& to_shoulder, const Vector3f& to_hand,
                     const Quaternionf& R_WU, bool bends) {
  const Vector3f rest = R_WU * (side == 0 ? Vector3f::UnitY() : Vector3f(-Vector3f::UnitY()));
  const Vector3f normal = to_shoulder.cross(to_hand);
  const float sine = normal.norm();
  if (sine < 1e-3f) return rest;
  // What opens comes out straight whatever the plane was.
  if (!bends || sine >= kPlaneOfElbow) return normal / sine;
  const Vector3f blend = smooth_step(sine / kPlaneOfElbow) * (normal / sine - rest) + rest;
  return blend.norm() > 0.05f ? Vector3f(blend.normalized()) : rest;
}

}  // namespace

float move_hand(std::size_t side, const Vector3f& shift_W_m, Pose& pose, BodyFrames& frames) {
  if (!shift_W_m.allFinite() || shift_W_m.squaredNorm() < 1e-12f) return 0.0f;
  const Limb& arm = kArms[side];
  const std::size_t upper = index_of(arm.upper), lower = index_of(arm.lower),
                    hand = index_of(arm.end);
  const Vector3f shoulder = frames.p_WB_m[upper];
  const Vector3f target = frames.p_WB_m[hand] + shift_W_m;
  const Vector3f to_shoulder = shoulder - frames.p_WB_m[lower];
  const Vector3f to_hand = frames.p_WB_m[hand] - frames.p_WB_m[lower];
  const float a = to_shoulder.norm(), b = to_hand.norm();
  if (a < kShortestArm_m || b < kShortestArm_m) return shift_W_m.norm();

  // cos γ = (a² + b² − d²) / 2ab, where γ is the angle between the two bones.
  const float now = (frames.p_WB_m[hand] - shoulder).norm();
  const float most = std::max(now, kStraightArm * (a + b));
  const float reach = std::clamp((target - shoulder).norm(), std::abs(a - b) + 1e-3f, most);
  const auto angle_at = [&](float d) {
    return std::acos(std::clamp((a * a + b * b - d * d) / (2.0f * a * b), -1.0f, 1.0f));
  };
  const bool bends = reach < now;
  const Vector3f hinge = elbow_hinge(side, to_shoulder / a, to_hand / b, frames.R_WB[upper], bends);
  float turn = angle_at(reach) - angle_at(now);
  // About a hinge that is not the plane's own, γ changes by less than the turn.
  for (int i = 0; i < 4 && bends; ++i) {
    const Vector3f bent = AngleAxisf(turn, hinge) * to_hand;
    const float miss = angle_at(reach) - angle_at((bent - to_shoulder).norm());
    turn = std::max(turn + miss, -kMostTurn_rad);
  }
  const Quaternionf bend(AngleAxisf(turn, hinge));
  const Vector3f bent_hand = frames.p_WB_m[lower] + bend * to_hand;
  const Quaternionf swing =
      shortest_turn((bent_hand - shoulder).cast<double>(), (target - shoulder).cast<double>())
          .cast<float>();

  const Quaternionf R_WHand = frames.R_WB[hand];
  const Quaternionf R_WU = (swing * frames.R_WB[upper]).normalized();
  const Quaternionf R_WL = (swing * bend * frames.R_WB[lower]).normalized();
  if (!R_WU.coeffs().allFinite() || !R_WL.coeffs().allFinite()) return shift_W_m.norm();
  const auto parent = static_cast<std::size_t>(kBones[upper].parent);
  pose.R_PB[upper] = (frames.R_WB[parent].conjugate() * R_WU).normalized();
  pose.R_PB[lower] = (R_WU.conjugate() * R_WL).normalized();
  pose.R_PB[hand] = (R_WL.conjugate() * R_WHand).normalized();

  const Vector3f p_elbow = shoulder + swing * (frames.p_WB_m[lower] - shoulder);
  const Vector3f p_hand = shoulder + swing * (bent_hand - shoulder);
  const Tip tip = side == 0 ? Tip::kLeftHand : Tip::kRightHand;
  frames.p_WT_m[static_cast<std::size_t>(tip)] += p_hand - frames.p_WB_m[hand];
  frames.R_WB[upper] = R_WU;
  frames.R_WB[lower] = R_WL;
  frames.p_WB_m[lower] = p_elbow;
  frames.p_WB_m[hand] = p_hand;
  return (target - p_hand).norm();
}

}  // namespace dance
