#include "formats/bvh/retarget_skeleton.h"

#include <algorithm>
#include <array>

#include "formats/bvh/rig/rig_correction.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Where in the middle of a gap an absent bone is laid.
constexpr double kShoulderOfWay = 0.2;  // from the chest to the upper arm
constexpr double kNeckOfWay = 0.6;      // from the chest to the head
constexpr double kToesOfFoot = 0.65;    // the ball, from ankle to tip
constexpr double kShortestEnd = 0.02;   // of the height: a shorter End Site is no body part

constexpr double kLowestHips = 0.2;  // of the height, above the floor

class Learner {
 public:
  Learner(const Bvh& bvh, const Rig& rig, const RigReference& reference)
      : bvh_(bvh),
        rig_(rig),
        reference_(reference),
        average_(average_skeleton(static_cast<float>(reference.height_m))),
        tree_(bvh) {}

  Skeleton learn() {
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (rig_.joint_of[b] != kNoJoint) place_[b] = reference_.p_W_m(rig_.joint_of[b]);
    place_absent_spine();
    place_absent_neck();
    place_absent_shoulder(Bone::kLeftShoulder, Bone::kLeftUpperArm);
    place_absent_shoulder(Bone::kRightShoulder, Bone::kRightUpperArm);
    place_absent_end(Bone::kLeftLowerArm, Bone::kLeftHand, 1.0);
    place_absent_end(Bone::kRightLowerArm, Bone::kRightHand, 1.0);
    place_absent_end(Bone::kLeftLowerLeg, Bone::kLeftFoot, 1.0);
    place_absent_end(Bone::kRightLowerLeg, Bone::kRightFoot, 1.0);
    place_absent_end(Bone::kLeftFoot, Bone::kLeftToes, kToesOfFoot);
    place_absent_end(Bone::kRightFoot, Bone::kRightToes, kToesOfFoot);
    return skeleton();
  }

 private:
  Vector3d& at(Bone bone) { return place_[index_of(bone)]; }
  const Quaterniond& C(Bone bone) const { return reference_.C[index_of(bone)]; }
  Vector3d average_offset(Bone bone) const { return average_.offset(bone).cast<double>(); }
  // A foot may be of several joints, all of which lead to its tip.
  Vector3d end_of(Bone bone) const {
    const bool foot = bone == Bone::kLeftFoot || bone == Bone::kRightFoot;
    return foot ? reference_.far_end_W_m(bvh_, rig_.joint(bone))
                : reference_.end_W_m(bvh_, rig_.joint(bone));
  }
  bool has_end(Bone bone) {
    return rig_.has(bone) && (end_of(bone) - at(bone)).norm() > kShortestEnd * reference_.height_m;
  }

  // Spine bones come in order, so the absent ones are the last: they share the way to the arms.
  void place_absent_spine() {
    const auto root_of = [this](Bone shoulder, Bone upper_arm) {
      return rig_.has(shoulder) ? at(shoulder) : at(upper_arm);
    };
    Vector3d top = 0.5 * (root_of(Bone::kLeftShoulder, Bone::kLeftUpperArm) +
                          root_of(Bone::kRightShoulder, Bone::kRightUpperArm));
    if (rig_.has(Bone::kNeck)) top = at(Bone::kNeck);
    constexpr Bone kSpineBones[] = {Bone::kSpine, Bone::kChest, Bone::kUpperChest};
    Bone last = Bone::kHips;
    double absent = 0.0;
    for (const Bone bone : kSpineBones) {
      if (rig_.has(bone))
        last = bone;
      else
        absent += 1.0;
    }
    const Vector3d begin = at(last);
    double step = 0.0;
    for (const Bone bone : kSpineBones)
      if (!rig_.has(bone)) at(bone) = begin + (step += 1.0) / (absent + 1.0) * (top - begin);
  }

  void place_absent_neck() {
    const Vector3d chest = at(Bone::kUpperChest);
    if (!rig_.has(Bone::kNeck))
      at(Bone::kNeck) = rig_.has(Bone::kHead)
                            ? Vector3d(chest + kNeckOfWay * (at(Bone::kHead) - chest))
                            : Vector3d(chest + C(Bone::kUpperChest) * average_offset(Bone::kNeck));
    if (!rig_.has(Bone::kHead))
      at(Bone::kHead) =
          has_end(Bone::kNeck)
              ? end_of(Bone::kNeck)
              : Vector3d(at(Bone::kNeck) + C(Bone::kNeck) * average_offset(Bone::kHead));
  }

  void place_absent_shoulder(Bone shoulder, Bone upper_arm) {
    if (rig_.has(shoulder)) return;
    const Vector3d chest = at(Bone::kUpperChest);
    at(shoulder) = chest + kShoulderOfWay * (at(upper_arm) - chest);
  }

  void place_absent_end(Bone bone, Bone end, double of_way) {
    if (rig_.has(end)) return;
    at(end) = has_end(bone) ? Vector3d(at(bone) + of_way * (end_of(bone) - at(bone)))
                            : Vector3d(at(bone) + C(bone) * average_offset(end));
  }

  // The end of the body behind one of its last bones.
  Vector3d tip_of(Tip tip) {
    const Bone bone = kTipBones[static_cast<std::size_t>(tip)];
    if (reference_.is_canonical) {
      const int last = tree_.longest_chain(rig_.joint(bone)).back();
      const Vector3d written = reference_.end_W_m(bvh_, last);
      if ((written - at(bone)).norm() > 1e-6) return written;
    }
    const Vector3d usual = at(bone) + C(bone) * average_.tip(tip).cast<double>();
    if (tip == Tip::kLeftHand || tip == Tip::kRightHand) {
      if (!rig_.has(bone)) return usual;
      const int last = tree_.longest_chain(rig_.joint(bone)).back();
      const Vector3d end = reference_.end_W_m(bvh_, last);
      const bool is_long = (end - at(bone)).norm() > kShortestEnd * reference_.height_m;
      return is_long && goes_on_from_forearm(usual - at(bone), end - at(bone)) ? end : usual;
    }
    if (has_end(bone)) return end_of(bone);
    const bool toes = tip == Tip::kLeftToes || tip == Tip::kRightToes;
    const Bone foot = static_cast<Bone>(kBones[index_of(bone)].parent);
    return toes && !rig_.has(bone) && has_end(foot) ? end_of(foot) : usual;
  }

  Skeleton skeleton() {
    Skeleton skeleton = average_;
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      skeleton.offset_m[b] =
          (reference_.C[parent].conjugate() * (place_[b] - place_[parent])).cast<float>();
    }
    for (std::size_t t = 0; t < kTipCount; ++t) {
      const Bone bone = kTipBones[t];
      skeleton.tip_m[t] =
          (C(bone).conjugate() * (tip_of(static_cast<Tip>(t)) - at(bone))).cast<float>();
    }
    const double written_m = reference_.metres_per_unit * bvh_.joints.front().offset.y();
    const bool is_written =
        reference_.is_canonical && written_m > kLowestHips * reference_.height_m;
    skeleton.offset_m[0] = Eigen::Vector3f(
        0.0f, is_written ? static_cast<float>(written_m) : hips_height(skeleton), 0.0f);
    return skeleton;
  }

  // In T-pose the lowest part of the feet is on the floor.
  static float hips_height(const Skeleton& s) {
    const auto lowest = [&s](Bone thigh, Bone shin, Bone foot, Bone toes, Tip tip) {
      const float ankle = s.offset(thigh).y() + s.offset(shin).y() + s.offset(foot).y();
      const float ball = ankle + s.offset(toes).y();
      return std::min({ankle, ball, ball + s.tip(tip).y()});
    };
    return -std::min(lowest(Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot,
                            Bone::kLeftToes, Tip::kLeftToes),
                     lowest(Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot,
                            Bone::kRightToes, Tip::kRightToes));
  }

  const Bvh& bvh_;
  const Rig& rig_;
  const RigReference& reference_;
  const Skeleton average_;
  const RigTree tree_;
  std::array<Vector3d, kBoneCount> place_{};
};

}  // namespace

Skeleton learn_skeleton(const Bvh& bvh, const Rig& rig, const RigReference& reference) {
  return Learner(bvh, rig, reference).learn();
}

}  // namespace dance
