#include "viewer/figure/foot_fit.h"

#include <algorithm>
#include <cmath>

#include "viewer/figure/limb_fit.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kHover_m = 0.06f;      // below it soles are brought nearer to the floor
constexpr float kUnchanged_m = 1e-5f;  // a foot that is there already
constexpr float kMostToeBend_rad = 1.0f;
// Hips come down for feet near the floor, not for kicks.
constexpr float kCarries_m = 0.03f;
constexpr float kSwings_m = 0.15f;
constexpr float kMostDrop = 0.35f;  // of the leg

float settled_m(float height_m) {
  if (height_m <= 0.0f) return 0.0f;
  const float kept = smooth_between(0.0f, kHover_m, height_m);
  return height_m * kept * kept;
}

// Toes that would point into the floor lie on it, where the ball of the foot is down.
void bend_toes(const FootPoints& points, std::size_t side, float ball_height_m,
               BodyFrames& frames) {
  const std::size_t toes = toes_of(side), foot = index_of(kLegLimbs[side].end);
  const Vector3f joint = frames.p_WB_m[toes];
  const Vector3f ball = frames.p_WB_m[foot] + frames.R_WB[foot] * points.ball_m;
  const Vector3f tip = joint + frames.R_WB[toes] * points.tip_m;
  const Vector3f along = tip - joint;
  const float length = along.norm();
  const float below = ball.y() - tip.y();
  if (length < 0.01f || below <= 0.0f) return;
  const float angle = std::min(std::asin(std::min(below / length, 1.0f)), kMostToeBend_rad) *
                      smooth_between(0.06f, 0.02f, ball_height_m);
  const Vector3f axis = along.cross(Vector3f::UnitY());
  if (axis.norm() < 1e-4f) return;
  const Quaternionf bend(Eigen::AngleAxisf(angle, axis.normalized()));
  frames.R_WB[toes] = (bend * frames.R_WB[toes]).normalized();
}

struct FootGoal {
  Vector3f ankle_W_m;
  float carries = 0.0f;
};

FootGoal goal_of(FigureFit& fit, std::size_t side) {
  const AvatarRig& rig = *fit.rig;
  const std::size_t foot = index_of(kLegLimbs[side].end), toes = toes_of(side);
  const Vector3f ball_was =
      fit.danced.p_WB_m[foot] + fit.danced.R_WB[foot] * rig.dancer_feet[side].ball_m;
  const float danced_m = lowest_m(rig.dancer_feet[side], fit.danced, side);
  if (!rig.is_own_body) bend_toes(rig.feet[side], side, ball_was.y(), fit.frames);
  // Where the foot would be with its ball there; then up or down until its lowest point fits.
  FootGoal goal;
  goal.ankle_W_m = ball_was - fit.frames.R_WB[foot] * rig.feet[side].ball_m;
  const Vector3f shift = goal.ankle_W_m - fit.frames.p_WB_m[foot];
  fit.frames.p_WB_m[foot] += shift;
  fit.frames.p_WB_m[toes] += shift;
  const float own_m = lowest_m(rig.feet[side], fit.frames, side);
  fit.frames.p_WB_m[foot] -= shift;
  fit.frames.p_WB_m[toes] -= shift;
  goal.ankle_W_m.y() += settled_m(danced_m * rig.leg_ratio) - own_m;
  goal.carries = smooth_between(kSwings_m, kCarries_m, danced_m);
  return goal;
}

float needed_drop_m(const FigureFit& fit, const std::array<FootGoal, 2>& goals) {
  float drop = 0.0f;
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = kLegLimbs[side];
    const float length =
        fit.rig->body.offset(leg.lower).norm() + fit.rig->body.offset(leg.end).norm();
    const Vector3f up = fit.frames.position(leg.upper) - goals[side].ankle_W_m;
    const float was = (fit.frames.position(leg.upper) - fit.frames.position(leg.end)).norm();
    const float reach = std::max(kStraightLimb * length, std::min(was, length));
    const float aside2 = up.x() * up.x() + up.z() * up.z();
    const float highest = std::sqrt(std::max(0.0f, reach * reach - aside2));
    const float wanted = std::min(up.y() - highest, kMostDrop * length);
    drop = std::max(drop, goals[side].carries * wanted);
  }
  return drop;
}

}  // namespace

float lowest_m(const FootPoints& points, const BodyFrames& frames, std::size_t side) {
  const std::size_t foot = index_of(kLegLimbs[side].end), toes = toes_of(side);
  // Only the height: the second row of the rotation.
  const Vector3f up_foot = frames.R_WB[foot].conjugate() * Vector3f::UnitY();
  const Vector3f up_toes = frames.R_WB[toes].conjugate() * Vector3f::UnitY();
  float low = 1e9f;
  for (std::size_t i = 0; i < points.lowest.foot_count; ++i)
    low = std::min(low, frames.p_WB_m[foot].y() + up_foot.dot(points.lowest.foot_m[i]));
  for (std::size_t i = 0; i < points.lowest.toes_count; ++i)
    low = std::min(low, frames.p_WB_m[toes].y() + up_toes.dot(points.lowest.toes_m[i]));
  return low;
}

void fit_feet(FigureFit& fit) {
  std::array<FootGoal, 2> goals{goal_of(fit, 0), goal_of(fit, 1)};
  const float drop = needed_drop_m(fit, goals);
  if (drop > 0.0f)
    for (Vector3f& place : fit.frames.p_WB_m) place.y() -= drop;
  for (std::size_t side = 0; side < 2; ++side) {
    const Limb& leg = kLegLimbs[side];
    const std::size_t foot = index_of(leg.end), toes = toes_of(side);
    if ((goals[side].ankle_W_m - fit.frames.p_WB_m[foot]).norm() > kUnchanged_m)
      fit_limb(leg, goals[side].ankle_W_m, fit.R_W(leg.upper) * hinge_of(leg), 1.0f, fit.frames);
    fit.frames.p_WB_m[toes] =
        fit.frames.p_WB_m[foot] + fit.frames.R_WB[foot] * fit.rig->body.offset_m[toes];
  }
}

}  // namespace dance
