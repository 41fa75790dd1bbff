#include "formats/bvh/rig/rig_stance.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

using Eigen::Vector3d;

// Limits of "stands": legs within 45° of the trunk's line, hips level within 20°, shoulders turned
// against the hips by less than 45°, limbs nearly stretched.
constexpr double kLegsDown = 0.7;
constexpr double kHipsLevel = 0.35;
constexpr double kChestAlongHips = 0.7;
constexpr double kStretched = 0.8;
// Sine of the angle to the shin, below which a foot's next joint does not tell where it points.
constexpr double kFootAcross = 0.3;
// Parts of a standing body's height (Winter 2009: ankle 0.039, top of the head above its joint
// about 0.115, shoulder 0.818).
constexpr double kAnkleOfHeight = 0.039;
constexpr double kHeadOfHeight = 0.115;
constexpr double kShoulderOfHeight = 0.818;

double straightness_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double along = (b - a).norm() + (c - b).norm();
  return along > 0.0 ? (c - a).norm() / along : 0.0;
}

class Places {
 public:
  Places(const Bvh& bvh, const Rig& rig, const BvhFigure& figure)
      : bvh_(bvh), rig_(rig), figure_(figure) {}
  Vector3d at(Bone bone) const { return figure_.p_FJ[static_cast<std::size_t>(rig_.joint(bone))]; }
  Vector3d end(Bone bone, Bone next) const {
    return bone_end(bvh_, figure_, rig_.joint(bone), rig_.joint(next));
  }
  Vector3d far_end(Bone bone) const {
    return figure_.far_end_of(bvh_, static_cast<std::size_t>(rig_.joint(bone)));
  }
  bool has(Bone bone) const { return rig_.has(bone); }

 private:
  const Bvh& bvh_;
  const Rig& rig_;
  const BvhFigure& figure_;
};

// How far the lowest point of a foot is below its ankle.
double ankle_height(const Places& p, const Vector3d& up, Bone foot, Bone toes) {
  if (!p.has(foot)) return 0.0;
  double lowest = up.dot(p.end(foot, toes) - p.at(foot));
  const Bone last = p.has(toes) ? toes : foot;
  lowest = std::min(lowest, up.dot(p.far_end(last) - p.at(foot)));
  return std::max(0.0, -lowest);
}

double standing_height(const Places& p, const RigStance& stance, bool is_standing) {
  const double legs =
      ((p.at(Bone::kLeftLowerLeg) - p.at(Bone::kLeftUpperLeg)).norm() +
       (p.end(Bone::kLeftLowerLeg, Bone::kLeftFoot) - p.at(Bone::kLeftLowerLeg)).norm() +
       (p.at(Bone::kRightLowerLeg) - p.at(Bone::kRightUpperLeg)).norm() +
       (p.end(Bone::kRightLowerLeg, Bone::kRightFoot) - p.at(Bone::kRightLowerLeg)).norm()) /
      2.0;
  double below = legs + stance.trunk.norm();
  const Vector3d up = stance.up();
  if (is_standing)
    below += std::max(ankle_height(p, up, Bone::kLeftFoot, Bone::kLeftToes),
                      ankle_height(p, up, Bone::kRightFoot, Bone::kRightToes));
  else
    below *= 1.0 + kAnkleOfHeight;
  if (!p.has(Bone::kHead)) return below / kShoulderOfHeight;
  const Vector3d shoulders = (p.at(Bone::kLeftUpperArm) + p.at(Bone::kRightUpperArm)) / 2.0;
  const double to_head = std::max(0.0, up.dot(p.at(Bone::kHead) - shoulders));
  const double to_top = up.dot(p.end(Bone::kHead, Bone::kHead) - p.at(Bone::kHead));
  const double sum = below + to_head;
  return sum + std::max(to_top, kHeadOfHeight * sum * (to_top > 0.0 ? 0.0 : 1.0));
}

}  // namespace

Vector3d bone_end(const Bvh& bvh, const BvhFigure& figure, int joint, int next) {
  if (next != kNoJoint && next != joint) return figure.p_FJ[static_cast<std::size_t>(next)];
  return figure.end_of(bvh, static_cast<std::size_t>(joint));
}

Vector3d foot_direction(const Bvh& bvh, const Rig& rig, const BvhFigure& figure, bool is_left) {
  const int shin = rig.joint(is_left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg);
  const int foot = rig.joint(is_left ? Bone::kLeftFoot : Bone::kRightFoot);
  const int toes = rig.joint(is_left ? Bone::kLeftToes : Bone::kRightToes);
  if (foot == kNoJoint) return Vector3d::Zero();
  const Vector3d ankle = figure.p_FJ[static_cast<std::size_t>(foot)];
  const Vector3d to_end = figure.far_end_of(bvh, static_cast<std::size_t>(foot)) - ankle;
  if (toes == kNoJoint) return to_end;
  const Vector3d to_toes = figure.p_FJ[static_cast<std::size_t>(toes)] - ankle;
  const Vector3d down = ankle - figure.p_FJ[static_cast<std::size_t>(shin)];
  const bool is_below = to_toes.cross(down).norm() < kFootAcross * to_toes.norm() * down.norm();
  return is_below ? to_end : to_toes;
}

bool RigStance::stands() const {
  const double least = 0.02 * height;
  if (!(trunk.norm() > least) || !(hips_left.norm() > least) || !(chest_left.norm() > least))
    return false;
  const Vector3d hips = hips_left.normalized();
  return legs_down > kLegsDown && straightness > kStretched &&
         std::abs(hips.dot(up())) < kHipsLevel &&
         hips.dot(chest_left.normalized()) > kChestAlongHips;
}

RigStance stance_of(const Bvh& bvh, const Rig& rig, const BvhFigure& figure) {
  const Places p(bvh, rig, figure);
  RigStance stance;
  stance.hips_left = p.at(Bone::kLeftUpperLeg) - p.at(Bone::kRightUpperLeg);
  stance.chest_left = p.at(Bone::kLeftUpperArm) - p.at(Bone::kRightUpperArm);
  stance.trunk = (p.at(Bone::kLeftUpperArm) + p.at(Bone::kRightUpperArm) -
                  p.at(Bone::kLeftUpperLeg) - p.at(Bone::kRightUpperLeg)) /
                 2.0;
  const Vector3d up = stance.up();
  struct TriedLimb {
    Bone upper, lower, end;
    bool is_leg;
  };
  constexpr TriedLimb kLimbs[] = {
      {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot, true},
      {Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot, true},
      {Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand, false},
      {Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kRightHand, false}};
  stance.legs_down = 1.0;
  stance.straightness = 1.0;
  for (const TriedLimb& limb : kLimbs) {
    const Vector3d end = p.end(limb.lower, limb.end);
    stance.straightness =
        std::min(stance.straightness, straightness_of(p.at(limb.upper), p.at(limb.lower), end));
    if (limb.is_leg)
      stance.legs_down = std::min(stance.legs_down, -up.dot((end - p.at(limb.upper)).normalized()));
  }
  stance.toes_forward = Vector3d::Zero();
  for (const bool is_left : {true, false})
    stance.toes_forward += foot_direction(bvh, rig, figure, is_left);
  stance.height = standing_height(p, stance, stance.legs_down > kLegsDown);
  return stance;
}

Vector3d mean_up(const BvhMotion& motion, const Rig& rig) {
  const std::size_t count = motion.bvh().frame_count;
  const std::size_t step = sample_step(motion.bvh());
  Vector3d sum = Vector3d::Zero();
  double weight = 0.0;
  BvhFigure figure;
  for (std::size_t f = 0; f < count; f += step) {
    motion.figure_at(f, figure);
    const RigStance stance = stance_of(motion.bvh(), rig, figure);
    sum += stance.up();
    const auto leg = [&](Bone thigh, Bone shin, Bone foot) {
      return Vector3d(figure.p_FJ[static_cast<std::size_t>(rig.joint(thigh))] -
                      bone_end(motion.bvh(), figure, rig.joint(shin), rig.joint(foot)));
    };
    sum += 0.5 * leg(Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot).normalized();
    sum += 0.5 * leg(Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot).normalized();
    weight += 2.0;
  }
  return sum / std::max(1.0, weight);
}

}  // namespace dance
