#include "formats/bvh/rig/rig_correction.h"

#include <cmath>
#include <numbers>

#include "core/pose/shortest_turn.h"
#include "core/pose/skeleton.h"
#include "formats/bvh/rig/rig_stance.h"

namespace dance {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
// A zero pose within this of square stands square: some files lean by a degree or two.
constexpr double kSquare_rad = 20.0 * kRadPerDeg;
// Bent more than this, a limb's plane says how it is twisted.
constexpr double kBent_rad = 30.0 * kRadPerDeg;
// A foot at rest does not point further out than this.
constexpr double kWidestToes_rad = 60.0 * kRadPerDeg;
constexpr double kShortest_m = 0.005;

// The rotation whose columns are x, y made square to it, and their cross product.
Quaterniond square_frame(const Vector3d& y, const Vector3d& x_hint) {
  const Vector3d z = x_hint.cross(y);
  if (z.norm() < 1e-9 || y.norm() < 1e-9) return Quaterniond::Identity();
  Matrix3d m;
  m.col(1) = y.normalized();
  m.col(2) = z.normalized();
  m.col(0) = m.col(1).cross(m.col(2));
  return Quaterniond(m);
}

// The nearest rotation that maps axes to axes, where that is within kSquare_rad.
Quaterniond snapped(const Quaterniond& rotation) {
  const Matrix3d m = rotation.toRotationMatrix();
  const auto nearest_axis = [](const Vector3d& v) {
    int axis = 0;
    v.cwiseAbs().maxCoeff(&axis);
    return Vector3d(Vector3d::Unit(axis) * (v[axis] < 0.0 ? -1.0 : 1.0));
  };
  const Vector3d y = nearest_axis(m.col(1));
  const Vector3d x = nearest_axis(m.col(0));
  if (std::abs(x.dot(y)) > 0.5) return rotation;
  const Quaterniond square = square_frame(y, x);
  return square.angularDistance(rotation) <= kSquare_rad ? square : rotation;
}

// Turns `from`'s rotation so that its direction e comes to lie along d.
Quaterniond swung(const Quaterniond& from, const Vector3d& e, const Vector3d& d) {
  if (d.norm() < kShortest_m) return from;
  return (shortest_turn(from * e, d) * from).normalized();
}

struct LimbBones {
  Bone parent, upper, lower, end;
};

class Corrections {
 public:
  Corrections(const Bvh& bvh, const Rig& rig, RigReference& reference)
      : bvh_(bvh), rig_(rig), reference_(reference), average_(average_skeleton()) {}

  void find() {
    trunk();
    limb({Bone::kUpperChest, Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand},
         Vector3d::UnitX(), -Vector3d::UnitY());
    limb({Bone::kUpperChest, Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kRightHand},
         -Vector3d::UnitX(), Vector3d::UnitY());
    limb({Bone::kHips, Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot},
         -Vector3d::UnitY(), Vector3d::UnitX());
    limb({Bone::kHips, Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot},
         -Vector3d::UnitY(), Vector3d::UnitX());
    foot(Bone::kLeftLowerLeg, Bone::kLeftFoot, Bone::kLeftToes);
    foot(Bone::kRightLowerLeg, Bone::kRightFoot, Bone::kRightToes);
    hand(true);
    hand(false);
  }

 private:
  Quaterniond& C(Bone bone) { return reference_.C[index_of(bone)]; }
  Vector3d at(int joint) const { return reference_.p_W_m(joint); }
  // From a bone's joint to the next one's, or to its own end.
  Vector3d along(Bone bone, Bone next) const {
    if (!rig_.has(bone)) return Vector3d::Zero();
    const Vector3d end = rig_.has(next) && next != bone
                             ? at(rig_.joint(next))
                             : reference_.end_W_m(bvh_, rig_.joint(bone));
    return end - at(rig_.joint(bone));
  }

  void trunk() {
    const RigStance stance = stance_of(bvh_, rig_, reference_.figure);
    const Vector3d up = reference_.R_WF * stance.trunk;
    Quaterniond hips = square_frame(up, reference_.R_WF * stance.hips_left);
    Quaterniond chest = square_frame(up, reference_.R_WF * stance.chest_left);
    if (reference_.is_zero_pose) {
      hips = snapped(hips);
      chest = hips;
    }
    C(Bone::kHips) = hips;
    C(Bone::kSpine) = hips.slerp(1.0 / 3.0, chest);
    C(Bone::kChest) = hips.slerp(2.0 / 3.0, chest);
    for (const Bone bone :
         {Bone::kUpperChest, Bone::kNeck, Bone::kHead, Bone::kLeftShoulder, Bone::kRightShoulder})
      C(bone) = chest;
    // A bone that the file does not have turns with its parent, so it must begin with it too.
    for (const Bone bone : {Bone::kSpine, Bone::kChest, Bone::kUpperChest})
      if (!rig_.has(bone))
        C(bone) = reference_.C[static_cast<std::size_t>(kBones[index_of(bone)].parent)];
    for (const Bone bone : {Bone::kNeck, Bone::kHead, Bone::kLeftShoulder, Bone::kRightShoulder})
      if (!rig_.has(bone))
        C(bone) = reference_.C[static_cast<std::size_t>(kBones[index_of(bone)].parent)];
  }

  // e is the bones' direction in T-pose, hinge the axis about which the joint bends there.
  void limb(const LimbBones& bones, const Vector3d& e, const Vector3d& hinge) {
    const Vector3d upper = along(bones.upper, bones.lower);
    const Vector3d lower = along(bones.lower, bones.end);
    const Vector3d bend_axis = upper.cross(lower);
    const bool is_bent = bend_axis.norm() > std::sin(kBent_rad) * upper.norm() * lower.norm() &&
                         lower.norm() > kShortest_m && upper.norm() > kShortest_m;
    const auto& begin =
        reference_.C[static_cast<std::size_t>(kBones[index_of(bones.upper)].parent)];
    C(bones.upper) = is_bent ? square_frame(upper, bend_axis) * square_frame(e, hinge).conjugate()
                             : swung(begin, e, upper);
    C(bones.lower) = swung(C(bones.upper), e, lower);
    C(bones.end) = C(bones.lower);
  }

  void foot(Bone shin, Bone foot, Bone toes) {
    const Vector3d canonical = average_.offset(toes).cast<double>().normalized();
    const Vector3d direction =
        reference_.R_WF * (reference_.metres_per_unit *
                           foot_direction(bvh_, rig_, reference_.figure, foot == Bone::kLeftFoot));
    const Quaterniond& hips = C(Bone::kHips);
    const Vector3d in_body = hips.conjugate() * direction;
    const double yaw_rad = std::atan2(in_body.x(), in_body.z());
    const bool lies_flat = std::hypot(in_body.x(), in_body.z()) > 0.3 * in_body.norm() &&
                           std::abs(yaw_rad) < kWidestToes_rad;
    if (direction.norm() < kShortest_m)
      C(foot) = reference_.is_zero_pose ? hips : C(shin);
    else if (reference_.is_zero_pose && lies_flat)
      C(foot) = hips * Quaterniond(Eigen::AngleAxisd(yaw_rad, Vector3d::UnitY()));
    else
      C(foot) = swung(C(shin), canonical, direction);
    C(toes) = C(foot);
  }

  void hand(bool left) {
    const Bone lower = left ? Bone::kLeftLowerArm : Bone::kRightLowerArm;
    const Bone hand = left ? Bone::kLeftHand : Bone::kRightHand;
    const Vector3d e(left ? 1.0 : -1.0, 0.0, 0.0);
    const std::size_t first = left ? 0 : kFingerBoneCount / 2;
    const auto knuckle = [&](std::size_t finger) { return rig_.finger_of[first + 3 * finger]; };
    if (!rig_.has(hand)) {
      fingers(first, e);
      return;
    }
    const Vector3d wrist = at(rig_.joint(hand));
    Vector3d direction = along(hand, hand);
    if (knuckle(2) != kNoJoint)
      direction = at(knuckle(2)) - wrist;
    else if (!goes_on_from_forearm(C(lower) * e, direction))
      direction = Vector3d::Zero();
    // The palm of a T-pose faces down: from the little finger's knuckle to the index finger's is
    // forwards. What is turned otherwise is turned from the elbow on, as an arm does it.
    if (knuckle(1) != kNoJoint && knuckle(4) != kNoJoint) {
      const Vector3d across = C(lower).conjugate() * (at(knuckle(1)) - at(knuckle(4)));
      const double sign = left ? 1.0 : -1.0;
      if (std::hypot(across.y(), across.z()) > kShortest_m) {
        // About +X, z goes to −y.
        const double angle_rad = std::atan2(-across.y(), across.z());
        C(lower) = C(lower) * Quaterniond(Eigen::AngleAxisd(angle_rad * sign, e));
      }
    }
    C(hand) = swung(C(lower), e, direction);
    fingers(first, e);
  }

  void fingers(std::size_t first, const Vector3d& e) {
    const Bone hand = first == 0 ? Bone::kLeftHand : Bone::kRightHand;
    const Vector3d thumb = (e + Vector3d::UnitZ()).normalized();
    for (std::size_t f = first; f < first + kFingerBoneCount / 2; ++f) {
      const bool begins = (f - first) % 3 == 0;
      const Quaterniond before = begins ? C(hand) : reference_.C_finger[f - 1];
      reference_.C_finger[f] = before;
      const int joint = rig_.finger_of[f];
      if (joint == kNoJoint) continue;
      const int next = (f - first) % 3 < 2 ? rig_.finger_of[f + 1] : kNoJoint;
      const Vector3d end = next != kNoJoint ? at(next) : reference_.end_W_m(bvh_, joint);
      // Phalanges are short: a millimetre tells their direction.
      if ((end - at(joint)).norm() < 0.001) continue;
      const Vector3d rest = f - first < 3 ? thumb : e;
      const Quaterniond turn = shortest_turn(before * rest, end - at(joint));
      reference_.C_finger[f] = (turn * before).normalized();
    }
  }

  const Bvh& bvh_;
  const Rig& rig_;
  RigReference& reference_;
  const Skeleton average_;
};

}  // namespace

bool goes_on_from_forearm(const Vector3d& forearm, const Vector3d& end) {
  constexpr double kMostBent = 0.5;  // cosine: 60°
  return forearm.dot(end) > kMostBent * forearm.norm() * end.norm();
}

void find_corrections(const Bvh& bvh, const Rig& rig, RigReference& reference) {
  reference.C.fill(Quaterniond::Identity());
  reference.C_finger.fill(Quaterniond::Identity());
  if (reference.is_canonical) return;
  Corrections(bvh, rig, reference).find();
}

}  // namespace dance
