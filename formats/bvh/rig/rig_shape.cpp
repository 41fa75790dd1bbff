#include "formats/bvh/rig/rig_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/bvh/rig/rig_chain.h"

namespace dance {
namespace {

using Eigen::Vector3d;

// Two limbs of one body differ by less than this, and are longer than this part of the body.
constexpr double kSameLength = 0.1;
constexpr double kShortestLimb = 0.15;

double branch_length(const RigTree& tree, int joint) {
  return tree.length(joint) + tree.reach(joint);
}

// The longest two children of a joint that mirror each other.
std::optional<std::pair<int, int>> mirrored_pair(const RigTree& tree, int joint, double body) {
  std::optional<std::pair<int, int>> best;
  double best_length = kShortestLimb * body;
  const auto& below = tree.children(joint);
  for (std::size_t a = 0; a < below.size(); ++a)
    for (std::size_t b = a + 1; b < below.size(); ++b) {
      const double length_a = branch_length(tree, below[a]);
      const double length_b = branch_length(tree, below[b]);
      const bool same = std::abs(length_a - length_b) <= kSameLength * std::max(length_a, length_b);
      const bool apart =
          (tree.rest(below[a]) - tree.rest(below[b])).norm() > tree.shortest_bone() ||
          tree.length(below[a]) < tree.shortest_bone();
      const bool deep = !tree.children(below[a]).empty() && !tree.children(below[b]).empty();
      if (!same || !apart || !deep || std::min(length_a, length_b) <= best_length) continue;
      best = {below[a], below[b]};
      best_length = std::min(length_a, length_b);
    }
  return best;
}

// The thigh and shin (upper and lower arm) of a branch are its two longest bones in a row.
struct LimbJoints {
  int before = kNoJoint;
  int upper = kNoJoint;
  int lower = kNoJoint;
  int end = kNoJoint;
  int after = kNoJoint;
};
std::optional<LimbJoints> limb_of(const RigTree& tree, int branch) {
  const std::vector<int> chain = tree.longest_chain(branch);
  const auto bone_length = [&](std::size_t i) {
    if (i + 1 < chain.size()) return tree.length(chain[i + 1]);
    const auto& end = tree.at(chain[i]).end_site;
    return end ? end->norm() : 0.0;
  };
  std::optional<std::size_t> best;
  double best_length = 0.0;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const double length = std::min(bone_length(i), bone_length(i + 1));
    if (length <= best_length) continue;
    best = i;
    best_length = length;
  }
  if (!best) return std::nullopt;
  const auto joint = [&](std::size_t i) { return i < chain.size() ? chain[i] : kNoJoint; };
  return LimbJoints{*best > 0 ? chain[*best - 1] : kNoJoint, chain[*best], chain[*best + 1],
                    joint(*best + 2), joint(*best + 3)};
}

Vector3d foot_direction(const RigTree& tree, const LimbJoints& leg) {
  if (leg.after != kNoJoint) return tree.at(leg.after).offset;
  const auto& end = leg.end != kNoJoint ? tree.at(leg.end).end_site : std::nullopt;
  return end ? *end : Vector3d::Zero();
}

struct Body {
  int hips;
  int shoulders;
  std::pair<int, int> legs;
  std::pair<int, int> arms;
};

// The joint nearest to the root with legs, and above it a joint with arms.
std::optional<Body> find_body(const RigTree& tree) {
  const double size = tree.size() > 0 ? tree.reach(0) : 0.0;
  for (int hips = 0; hips < static_cast<int>(tree.size()); ++hips) {
    const auto legs = mirrored_pair(tree, hips, size);
    if (!legs) continue;
    for (int shoulders = hips + 1; shoulders < static_cast<int>(tree.size()); ++shoulders) {
      if (!tree.is_above(hips, shoulders) || tree.is_above(legs->first, shoulders) ||
          tree.is_above(legs->second, shoulders))
        continue;
      if (const auto arms = mirrored_pair(tree, shoulders, size))
        return Body{hips, shoulders, *legs, *arms};
    }
  }
  return std::nullopt;
}

void place_leg(Rig& rig, const LimbJoints& leg, bool left) {
  rig[left ? Bone::kLeftUpperLeg : Bone::kRightUpperLeg] = leg.upper;
  rig[left ? Bone::kLeftLowerLeg : Bone::kRightLowerLeg] = leg.lower;
  rig[left ? Bone::kLeftFoot : Bone::kRightFoot] = leg.end;
  rig[left ? Bone::kLeftToes : Bone::kRightToes] = leg.after;
}

void place_arm(Rig& rig, const LimbJoints& arm, bool left) {
  rig[left ? Bone::kLeftShoulder : Bone::kRightShoulder] = arm.before;
  rig[left ? Bone::kLeftUpperArm : Bone::kRightUpperArm] = arm.upper;
  rig[left ? Bone::kLeftLowerArm : Bone::kRightLowerArm] = arm.lower;
  rig[left ? Bone::kLeftHand : Bone::kRightHand] = arm.end;
}

}  // namespace

std::optional<Rig> find_rig_by_shape(const RigTree& tree) {
  const auto body = find_body(tree);
  if (!body) return std::nullopt;
  const auto leg_a = limb_of(tree, body->legs.first);
  const auto leg_b = limb_of(tree, body->legs.second);
  const auto arm_a = limb_of(tree, body->arms.first);
  const auto arm_b = limb_of(tree, body->arms.second);
  if (!leg_a || !leg_b || !arm_a || !arm_b) return std::nullopt;

  // Left is up × forward, and forward is where the feet point.
  const Vector3d up = tree.rest(body->shoulders) - tree.rest(body->hips);
  const Vector3d forward = foot_direction(tree, *leg_a) + foot_direction(tree, *leg_b);
  const Vector3d left = up.cross(forward);
  const double legs_apart = left.dot(tree.rest(leg_a->upper) - tree.rest(leg_b->upper));
  const double arms_apart = left.dot(tree.rest(arm_a->upper) - tree.rest(arm_b->upper));
  const double least = 1e-3 * up.norm() * forward.norm() * tree.reach(body->hips);
  if (!(std::abs(legs_apart) > least) || !(std::abs(arms_apart) > least)) return std::nullopt;

  Rig rig;
  rig.is_from_names = false;
  place_leg(rig, *leg_a, legs_apart > 0.0);
  place_leg(rig, *leg_b, legs_apart < 0.0);
  place_arm(rig, *arm_a, arms_apart > 0.0);
  place_arm(rig, *arm_b, arms_apart < 0.0);
  place_trunk(tree, kNoJoint, {}, rig);
  return rig;
}

}  // namespace dance
