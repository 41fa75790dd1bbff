#include "viewer/figure/arm_fit.h"

#include <algorithm>
#include <cmath>

#include "viewer/figure/limb_fit.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kMostShoulder_rad = 0.3f;
constexpr float kMostLean_rad = 0.17f;
constexpr float kFastestElbow_rad_s = 6.0f;
// Of what shoulder and back could add if they pointed at their best: contacts are planned with this
// share.
constexpr float kCounted = 0.6f;

Bone shoulder_of(std::size_t side) {
  return side == 0 ? Bone::kLeftShoulder : Bone::kRightShoulder;
}

float arm_length_m(const FigureFit& fit, std::size_t side) {
  return fit.rig->body.offset(kArmLimbs[side].lower).norm() +
         fit.rig->body.offset(kArmLimbs[side].end).norm();
}

// The lowest bone of the back, about which it leans.
std::optional<Bone> lumbar_of(const AvatarShape& shape) {
  for (const Bone bone : {Bone::kSpine, Bone::kChest, Bone::kUpperChest})
    if (shape.has(bone)) return bone;
  return std::nullopt;
}

// The turn about `pivot` that brings `place` by `need` along `towards`, by `most` at most.
Vector3f turn_towards(const Vector3f& pivot, const Vector3f& place, const Vector3f& towards,
                      float need_m, float most_rad) {
  const Vector3f arm = place - pivot;
  const Vector3f axis = arm.cross(towards);  // as long as the turn is effective
  const float effect_m = axis.norm();
  if (effect_m < 1e-4f || arm.norm() < 1e-3f) return Vector3f::Zero();
  const float bound = most_rad * effect_m / arm.norm();
  return axis / effect_m * std::min(need_m / effect_m, bound);
}

Quaternionf rotation_of(const Vector3f& v) {
  const float angle = v.norm();
  if (angle < 1e-7f) return Quaternionf::Identity();
  return Quaternionf(Eigen::AngleAxisf(angle, v / angle));
}

struct Reach {
  Vector3f wrist_W_m;
  bool is_wanted = false;

  // What is missing, and the direction in which.
  float need_m(const FigureFit& fit, std::size_t side, Vector3f& towards) const {
    towards = wrist_W_m - fit.frames.position(kArmLimbs[side].upper);
    const float distance = towards.norm();
    if (distance < 1e-4f) return 0.0f;
    towards /= distance;
    return std::max(0.0f, distance - arm_reach_m(fit, side));
  }
};

void lean(const std::array<Reach, 2>& reaches, FigureFit& fit) {
  const std::optional<Bone> lumbar = lumbar_of(*fit.rig->shape);
  if (!lumbar) return;
  const Vector3f pivot = fit.frames.position(*lumbar);
  Vector3f turn = Vector3f::Zero();
  for (std::size_t side = 0; side < 2; ++side) {
    if (!reaches[side].is_wanted) continue;
    Vector3f towards;
    float need = reaches[side].need_m(fit, side, towards);
    if (fit.rig->shape->has(shoulder_of(side)))  // what the shoulder will do
      need -= kMostShoulder_rad * kCounted * fit.rig->body.offset(kArmLimbs[side].upper).norm();
    if (need <= 0.0f) continue;
    turn += turn_towards(pivot, fit.frames.position(kArmLimbs[side].upper), towards, need,
                         kMostLean_rad);
  }
  if (turn.norm() < 1e-7f) return;
  if (turn.norm() > kMostLean_rad) turn *= kMostLean_rad / turn.norm();
  const Quaternionf rotation = rotation_of(turn);
  for (std::size_t b = index_of(Bone::kSpine); b <= index_of(Bone::kRightHand); ++b) {
    fit.frames.p_WB_m[b] = pivot + rotation * (fit.frames.p_WB_m[b] - pivot);
    fit.frames.R_WB[b] = (rotation * fit.frames.R_WB[b]).normalized();
  }
}

void raise_shoulder(const Reach& reach, std::size_t side, FigureFit& fit) {
  const Bone shoulder = shoulder_of(side);
  if (!fit.rig->shape->has(shoulder)) return;
  Vector3f towards;
  const float need = reach.need_m(fit, side, towards);
  if (need <= 0.0f) return;
  const Vector3f pivot = fit.frames.position(shoulder);
  const Quaternionf rotation = rotation_of(turn_towards(
      pivot, fit.frames.position(kArmLimbs[side].upper), towards, need, kMostShoulder_rad));
  auto& R_W = fit.frames.R_WB[index_of(shoulder)];
  R_W = (rotation * R_W).normalized();
  const Vector3f was = fit.frames.position(kArmLimbs[side].upper);
  const Vector3f moved = pivot + rotation * (was - pivot) - was;
  for (const Bone bone : {kArmLimbs[side].upper, kArmLimbs[side].lower, kArmLimbs[side].end})
    fit.frames.p_WB_m[index_of(bone)] += moved;
}

}  // namespace

float arm_reach_m(const FigureFit& fit, std::size_t side) {
  return kStraightLimb * arm_length_m(fit, side);
}

float arm_help_m(const FigureFit& fit, std::size_t side) {
  const Skeleton& body = fit.rig->body;
  float help = (kMostStretch - 1.0f) * arm_length_m(fit, side);
  if (fit.rig->shape->has(shoulder_of(side)))
    help += kCounted * kMostShoulder_rad * body.offset(kArmLimbs[side].upper).norm();
  if (const auto lumbar = lumbar_of(*fit.rig->shape))
    help += kCounted * kMostLean_rad *
            (fit.frames.position(kArmLimbs[side].upper) - fit.frames.position(*lumbar)).norm();
  return help;
}

void fit_arms(const std::array<std::optional<Vector3f>, 2>& palms_W_m, FigureFit& fit) {
  if (fit.past)
    for (std::size_t side = 0; side < 2; ++side) {
      LimbSide& elbow = fit.past->elbows[side];
      elbow.is_known = elbow.is_known && fit.past->is_known && palms_W_m[side];
      elbow.most_turn_rad = kFastestElbow_rad_s * fit.past->passed_s;
    }
  if (!palms_W_m[0] && !palms_W_m[1]) return;
  std::array<Reach, 2> reaches;
  std::array<Quaternionf, 2> R_WHand;
  for (std::size_t side = 0; side < 2; ++side) {
    R_WHand[side] = fit.R_W(kArmLimbs[side].end);
    if (!palms_W_m[side]) continue;
    reaches[side].is_wanted = true;
    reaches[side].wrist_W_m = *palms_W_m[side] - R_WHand[side] * fit.rig->palms_m[side];
  }
  lean(reaches, fit);
  for (std::size_t side = 0; side < 2; ++side) {
    if (!reaches[side].is_wanted) continue;
    raise_shoulder(reaches[side], side, fit);
    const Limb& arm = kArmLimbs[side];
    const float distance = (reaches[side].wrist_W_m - fit.frames.position(arm.upper)).norm();
    const float stretch = std::clamp(distance / arm_reach_m(fit, side), 1.0f, kMostStretch);
    fit_limb(arm, reaches[side].wrist_W_m, fit.R_W(arm.upper) * hinge_of(arm), stretch, fit.frames,
             fit.past ? &fit.past->elbows[side] : nullptr);
    fit.arm_stretch[side] = stretch;
    fit.frames.R_WB[index_of(arm.end)] = R_WHand[side];
  }
}

}  // namespace dance
