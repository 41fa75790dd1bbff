#include "formats/bvh/rig/rig_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/bvh/rig/rig_chain.h"
#include "formats/bvh/rig/rig_fingers.h"
#include "formats/bvh/rig/rig_stance.h"

namespace dance {
namespace {

using Eigen::Vector3d;

// Bones of two sides differ by less than this, and most of two branches has its like.
constexpr double kSameLength = 0.1;
constexpr double kLeastMirrored = 0.6;
// Pairs of limbs beside the longest of the figure: fingers and skirts are shorter.
constexpr double kShortestLimb = 0.3;
constexpr std::size_t kTriedFrames = 16;

bool is_same(double a, double b) { return std::abs(a - b) <= kSameLength * std::max(a, b); }

struct LimbJoints {
  int before = kNoJoint;
  int upper = kNoJoint;
  int lower = kNoJoint;
  int end = kNoJoint;
  int after = kNoJoint;
};

// The way to the furthest end of a branch, and for each two bones of it that follow each other the
// length of the shorter.
struct LimbChain {
  std::vector<int> joints;
  std::vector<double> shorter;

  LimbChain(const RigTree& tree, int branch) : joints(tree.longest_chain(branch)) {
    const auto bone_length = [&](std::size_t i) {
      if (i + 1 < joints.size()) return (tree.rest(joints[i + 1]) - tree.rest(joints[i])).norm();
      const auto& end = tree.at(joints[i]).end_site;
      return end ? end->norm() : 0.0;
    };
    for (std::size_t i = 0; i + 1 < joints.size(); ++i)
      shorter.push_back(std::min(bone_length(i), bone_length(i + 1)));
  }
  LimbJoints limb_at(std::size_t i) const {
    const auto joint = [&](std::size_t k) { return k < joints.size() ? joints[k] : kNoJoint; };
    return {i > 0 ? joints[i - 1] : kNoJoint, joints[i], joints[i + 1], joint(i + 2), joint(i + 3)};
  }
};

// The lengths of all bones of a branch, in order.
std::vector<double> bones_of(const RigTree& tree, int branch) {
  std::vector<double> lengths;
  for (int j = branch; j < static_cast<int>(tree.size()); ++j) {
    if (!tree.is_above(branch, j)) continue;
    if (j != branch) lengths.push_back(tree.length(j));
    if (const auto& end = tree.at(j).end_site) lengths.push_back(end->norm());
  }
  std::erase_if(lengths, [&](double length) { return length < tree.shortest_bone(); });
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

// The part of two branches' bones, by length, that has a bone of the same length in the other.
double mirrored_part(const std::vector<double>& a, const std::vector<double>& b) {
  double all = 0.0;
  double same = 0.0;
  for (const double length : a) all += length;
  for (const double length : b) all += length;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    if (is_same(a[i], b[k]))
      same += a[i++] + b[k++];
    else
      ++(a[i] < b[k] ? i : k);
  }
  return all > 0.0 ? same / all : 0.0;
}

struct LimbPair {
  int joint = kNoJoint;  // that both hang from
  std::pair<int, int> branches;
  LimbJoints a, b;
  double shorter = 0.0;  // the length of the shorter bone of the limbs
};

// The thigh and shin (upper and lower arm) of two branches are the two bones in a row that are
// longest in both.
LimbPair limbs_of(int joint, const LimbChain& a, const LimbChain& b) {
  LimbPair pair;
  pair.joint = joint;
  const auto longest = [](const std::vector<double>& lengths) {
    return static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) -
                                    lengths.begin());
  };
  std::size_t at_a = longest(a.shorter);
  std::size_t at_b = longest(b.shorter);
  if (a.shorter.size() == b.shorter.size()) {
    std::vector<double> both = a.shorter;
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += b.shorter[i];
    at_a = at_b = longest(both);
  }
  pair.a = a.limb_at(at_a);
  pair.b = b.limb_at(at_b);
  pair.shorter = std::min(a.shorter[at_a], b.shorter[at_b]);
  return pair;
}

bool are_apart(const RigTree& tree, int a, int b) {
  return (tree.rest(a) - tree.rest(b)).norm() > tree.shortest_bone();
}

// The two children of a joint with the longest limbs that mirror each other.
std::optional<LimbPair> mirrored_pair(const RigTree& tree, int joint) {
  struct Branch {
    int joint;
    LimbChain chain;
    std::vector<double> bones;
  };
  std::vector<Branch> branches;
  for (const int child : tree.children(joint)) {
    LimbChain chain(tree, child);
    if (!chain.shorter.empty())
      branches.push_back({child, std::move(chain), bones_of(tree, child)});
  }
  std::optional<LimbPair> best;
  for (std::size_t a = 0; a < branches.size(); ++a)
    for (std::size_t b = a + 1; b < branches.size(); ++b) {
      const Branch& one = branches[a];
      const Branch& two = branches[b];
      const double length_a = tree.length(one.joint) + tree.reach(one.joint);
      const double length_b = tree.length(two.joint) + tree.reach(two.joint);
      if (!is_same(length_a, length_b)) continue;
      LimbPair pair = limbs_of(joint, one.chain, two.chain);
      // They may begin in one place, as helpers do, but not go on so.
      if (!are_apart(tree, pair.a.upper, pair.b.upper) &&
          !are_apart(tree, pair.a.lower, pair.b.lower))
        continue;
      pair.branches = {one.joint, two.joint};
      if (pair.shorter <= (best ? best->shorter : 0.0)) continue;
      if (mirrored_part(one.bones, two.bones) < kLeastMirrored) continue;
      best = pair;
    }
  return best;
}

bool is_in(const RigTree& tree, const LimbPair& pair, int joint) {
  return tree.is_above(pair.branches.first, joint) || tree.is_above(pair.branches.second, joint);
}

std::size_t ends_below(const RigTree& tree, int branch) {
  std::size_t ends = 0;
  for (int j = branch; j < static_cast<int>(tree.size()); ++j)
    ends += tree.children(j).empty() && tree.is_above(branch, j);
  return ends;
}

struct Body {
  LimbPair legs;
  LimbPair arms;
};

// The spine leads from the hips to the arms. Where both hang side by side below a root, hands have
// fingers, and legs are longer.
bool are_legs(const RigTree& tree, const LimbPair& a, const LimbPair& b) {
  if (tree.is_above(a.joint, b.joint)) return true;
  if (tree.is_above(b.joint, a.joint)) return false;
  const std::size_t ends_a = ends_below(tree, a.branches.first);
  const std::size_t ends_b = ends_below(tree, b.branches.first);
  if (ends_a != ends_b) return ends_a < ends_b;
  return a.shorter > b.shorter;
}

// The two longest pairs of limbs that are no parts of each other.
std::optional<Body> find_body(const RigTree& tree) {
  std::vector<LimbPair> pairs;
  for (int joint = 0; joint < static_cast<int>(tree.size()); ++joint)
    if (tree.children(joint).size() > 1)
      if (auto pair = mirrored_pair(tree, joint)) pairs.push_back(*pair);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const LimbPair& a, const LimbPair& b) { return a.shorter > b.shorter; });
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (pairs[i].shorter < kShortestLimb * pairs[0].shorter) break;
    if (is_in(tree, pairs[0], pairs[i].joint) || is_in(tree, pairs[i], pairs[0].joint)) continue;
    const bool first_are_legs = are_legs(tree, pairs[0], pairs[i]);
    return first_are_legs ? Body{pairs[0], pairs[i]} : Body{pairs[i], pairs[0]};
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

Rig rig_of(const RigTree& tree, const Body& body, bool legs_swapped, bool arms_swapped) {
  Rig rig;
  rig.is_from_names = false;
  place_leg(rig, body.legs.a, !legs_swapped);
  place_leg(rig, body.legs.b, legs_swapped);
  place_arm(rig, body.arms.a, !arms_swapped);
  place_arm(rig, body.arms.b, arms_swapped);
  place_trunk(tree, kNoJoint, {}, rig);
  return rig;
}

// The figure without rotations, and frames of its motion.
std::vector<BvhFigure> tried_figures(const Bvh& bvh) {
  const BvhMotion motion(bvh);
  std::vector<BvhFigure> figures(1);
  motion.zero_figure(figures[0]);
  const std::size_t step = std::max<std::size_t>(1, bvh.frame_count / kTriedFrames);
  for (std::size_t f = 0; f < bvh.frame_count; f += step) {
    figures.emplace_back();
    motion.figure_at(f, figures.back());
  }
  return figures;
}

// The direction of the feet, else that of the knees, which bend backwards and so stand in front of
// the leg.
Vector3d forward_of(const Bvh& bvh, const Rig& rig, const BvhFigure& figure) {
  constexpr Bone kLegs[][3] = {{Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot},
                               {Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot}};
  Vector3d feet = Vector3d::Zero();
  Vector3d knees = Vector3d::Zero();
  for (const auto& [thigh, shin, foot] : kLegs) {
    const Vector3d hip = figure.p_FJ[static_cast<std::size_t>(rig.joint(thigh))];
    const Vector3d knee = figure.p_FJ[static_cast<std::size_t>(rig.joint(shin))];
    const Vector3d ankle = bone_end(bvh, figure, rig.joint(shin), rig.joint(foot));
    if (rig.has(foot))
      feet += figure.far_end_of(bvh, static_cast<std::size_t>(rig.joint(foot))) - ankle;
    const Vector3d leg = ankle - hip;
    if (leg.norm() > 0.0) knees += knee - hip - leg * leg.dot(knee - hip) / leg.squaredNorm();
  }
  const Vector3d up = stance_of(bvh, rig, figure).up();
  feet -= up * up.dot(feet);
  return feet.norm() > 0.5 * knees.norm() ? feet : knees;
}

// Above zero where the rig's left is the figure's: left is up × forward.
double left_is_left(const Bvh& bvh, const Rig& rig, const std::vector<BvhFigure>& figures) {
  double standing = 0.0;
  for (const BvhFigure& figure : figures) {
    const RigStance stance = stance_of(bvh, rig, figure);
    if (!stance.stands()) continue;
    const Vector3d left = stance.up().cross(forward_of(bvh, rig, figure));
    standing += left.dot(stance.hips_left.normalized()) / stance.height;
  }
  return standing;
}

// Above zero where left arm and left leg are on one side.
double arms_fit_legs(const Bvh& bvh, const Rig& rig, const std::vector<BvhFigure>& figures) {
  double sum = 0.0;
  for (const BvhFigure& figure : figures) {
    const RigStance stance = stance_of(bvh, rig, figure);
    if (stance.legs_down > 0.0)
      sum += stance.hips_left.normalized().dot(stance.chest_left.normalized());
  }
  return sum;
}

}  // namespace

std::optional<Rig> find_rig_by_shape(const RigTree& tree) {
  constexpr double kLeast = 1e-3;
  const Bvh& bvh = tree.bvh();
  const auto body = find_body(tree);
  if (!body) return std::nullopt;
  Rig rig = rig_of(tree, *body, false, false);
  if (!missing_bones(rig).empty()) return std::nullopt;
  const std::vector<BvhFigure> figures = tried_figures(bvh);
  const bool arms_swapped = arms_fit_legs(bvh, rig, figures) < 0.0;
  rig = rig_of(tree, *body, false, arms_swapped);
  const double sides = left_is_left(bvh, rig, figures);
  if (!(std::abs(sides) > kLeast)) return std::nullopt;
  if (sides < 0.0) rig = rig_of(tree, *body, true, !arms_swapped);
  place_fingers_by_shape(tree, rig);
  return rig;
}

}  // namespace dance
