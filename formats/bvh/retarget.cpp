#include "formats/bvh/retarget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/pose/kinematics.h"
#include "core/pose/shortest_turn.h"
#include "formats/bvh/bvh_motion.h"
#include "formats/bvh/retarget_skeleton.h"
#include "formats/bvh/rig/rig_positions.h"
#include "formats/bvh/rig/rig_reference.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// The floor is this quantile of the lower foot's height: robust against jumps and the markers'
// noise.
constexpr double kFloorPercentile = 0.10;
// A finger that turns less than this in the whole take was not captured.
constexpr double kMovingFinger_rad = 0.035;

class Retargeter {
 public:
  Retargeter(const Bvh& bvh, const Rig& rig, const RetargetOptions& options)
      : bvh_(bvh), rig_(rig), options_(options), motion_(bvh, positions_of(bvh, rig)) {}

  Result<Retargeted> run() {
    out_.rig = rig_;
    out_.notes = bvh_.notes;
    if (!rig_.assumption.empty()) out_.notes.push_back(rig_.assumption);
    reference_ = find_reference(motion_, rig_, options_, out_.notes);
    out_.metres_per_unit = reference_.metres_per_unit;
    out_.clip.skeleton = learn_skeleton(bvh_, rig_, reference_);
    if (!is_valid(out_.clip.skeleton))
      return fail(
          "bones longer than 2 m: give the right unit to dance convert, as --unit cm; this "
          "one makes the figure " +
          std::to_string(std::llround(reference_.height_m)) + " m tall");
    out_.clip.frame_hz = options_.frame_hz.value_or(bvh_.frame_hz);
    find_turns();
    find_aims();
    find_moving_fingers();
    out_.clip.frames.resize(bvh_.frame_count);
    if (has_hands_) out_.clip.hands.resize(bvh_.frame_count);
    for (std::size_t f = 0; f < bvh_.frame_count; ++f) retarget_frame(f);
    if (options_.puts_feet_on_floor) put_on_floor();
    for (std::size_t f = 0; f < bvh_.frame_count; ++f)
      if (!is_valid(out_.clip.frames[f]))
        return fail("frame " + std::to_string(f + 1) +
                    ": the hips are no place on a stage; is the capture or the unit broken?");
    return std::move(out_);
  }

 private:
  // The factor to the right of R_WF · R_FJ(t): inverse reference, then the correction.
  Quaterniond turn_of(int joint, const Quaterniond& C) const {
    const Quaterniond& R_FJ = reference_.figure.R_FJ[static_cast<std::size_t>(joint)];
    return R_FJ.conjugate() * reference_.R_WF.conjugate() * C;
  }

  void find_turns() {
    for (std::size_t b = 0; b < kBoneCount; ++b)
      if (rig_.joint_of[b] != kNoJoint)
        turn_[b] = turn_of(rig_.joint_of[b], reference_.C[b]);
      else
        presence_ &= ~(1u << b);
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      if (rig_.finger_of[f] != kNoJoint)
        finger_turn_[f] = turn_of(rig_.finger_of[f], reference_.C_finger[f]);
  }

  bool moves_against(int ancestor, int joint) const {
    const RigTree tree(bvh_);
    const std::vector<int> path = tree.path(ancestor, joint);
    if (path.size() > 1) return true;
    const BvhJoint& own = tree.at(joint);
    return std::any_of(own.channels.begin(),
                       own.channels.begin() + static_cast<std::ptrdiff_t>(own.channel_count),
                       [](BvhChannel c) { return is_position(c); });
  }

  void find_aims() {
    constexpr Bone kStraight[][2] = {{Bone::kSpine, Bone::kChest},
                                     {Bone::kChest, Bone::kUpperChest},
                                     {Bone::kNeck, Bone::kHead},
                                     {Bone::kLeftShoulder, Bone::kLeftUpperArm},
                                     {Bone::kLeftUpperArm, Bone::kLeftLowerArm},
                                     {Bone::kLeftLowerArm, Bone::kLeftHand},
                                     {Bone::kRightShoulder, Bone::kRightUpperArm},
                                     {Bone::kRightUpperArm, Bone::kRightLowerArm},
                                     {Bone::kRightLowerArm, Bone::kRightHand},
                                     {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg},
                                     {Bone::kLeftLowerLeg, Bone::kLeftFoot},
                                     {Bone::kLeftFoot, Bone::kLeftToes},
                                     {Bone::kRightUpperLeg, Bone::kRightLowerLeg},
                                     {Bone::kRightLowerLeg, Bone::kRightFoot},
                                     {Bone::kRightFoot, Bone::kRightToes}};
    for (const auto& [bone, target] : kStraight)
      if (rig_.has(bone) && rig_.has(target) && moves_against(rig_.joint(bone), rig_.joint(target)))
        aims_[index_of(bone)] = static_cast<int>(index_of(target));
  }

  void find_moving_fingers() {
    std::size_t fingers = 0;
    for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
      const int joint = rig_.finger_of[f];
      if (joint == kNoJoint) continue;
      if (f % 3 == 0) ++fingers;
      has_hands_ = has_hands_ || joint_moves(joint);
      finger_presence_ |= 1u << f;
    }
    // CMU has a thumb only, which is no hand.
    has_hands_ = (has_hands_ || reference_.is_canonical) && fingers > 2;
  }

  bool joint_moves(int index) const {
    constexpr double kDegPerRad = 57.29577951308232;
    const BvhJoint& joint = bvh_.joints[static_cast<std::size_t>(index)];
    for (std::size_t c = 0; c < joint.channel_count; ++c) {
      if (!is_rotation(joint.channels[c])) continue;
      const std::size_t at = joint.first_channel + c;
      float least = bvh_.frame(0)[at];
      float most = least;
      for (std::size_t f = 1; f < bvh_.frame_count; ++f) {
        least = std::min(least, bvh_.frame(f)[at]);
        most = std::max(most, bvh_.frame(f)[at]);
      }
      if (static_cast<double>(most - least) > kMovingFinger_rad * kDegPerRad) return true;
    }
    return false;
  }

  Vector3d place_of(std::size_t bone) const {
    return figure_.p_FJ[static_cast<std::size_t>(rig_.joint_of[bone])];
  }

  void retarget_frame(std::size_t frame) {
    motion_.figure_at(frame, figure_);
    std::array<Quaterniond, kBoneCount> R_WB;
    Pose& pose = out_.clip.frames[frame];
    pose.presence = presence_;
    pose.p_WH_m = (reference_.R_WF * (reference_.metres_per_unit * place_of(0))).cast<float>();
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const int parent = kBones[b].parent;
      const Quaterniond R_WP =
          parent < 0 ? Quaterniond::Identity() : R_WB[static_cast<std::size_t>(parent)];
      R_WB[b] = R_WP;
      if (rig_.joint_of[b] != kNoJoint) {
        const auto joint = static_cast<std::size_t>(rig_.joint_of[b]);
        R_WB[b] = reference_.R_WF * figure_.R_FJ[joint] * turn_[b];
        aim(b, R_WB[b]);
      }
      set(pose.R_PB[b], R_WP.conjugate() * R_WB[b],
          frame > 0 ? &out_.clip.frames[frame - 1].R_PB[b] : nullptr);
    }
    if (has_hands_) retarget_hands(frame, R_WB);
  }

  // Turns the bone the shortest way so that it points where the file has its other end.
  void aim(std::size_t bone, Quaterniond& R_WB) const {
    if (aims_[bone] < 0) return;
    const auto target = static_cast<std::size_t>(aims_[bone]);
    const Vector3d now = R_WB * out_.clip.skeleton.offset_m[target].cast<double>();
    const Vector3d wanted = reference_.R_WF * (place_of(target) - place_of(bone));
    if (now.norm() < 1e-4 || wanted.norm() * reference_.metres_per_unit < 1e-4) return;
    R_WB = (shortest_turn(now, wanted) * R_WB).normalized();
  }

  void retarget_hands(std::size_t frame, const std::array<Quaterniond, kBoneCount>& R_WB) {
    Hands& hands = out_.clip.hands[frame];
    hands.presence = finger_presence_;
    std::array<Quaterniond, kFingerBoneCount> R_WF;
    for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
      const bool left = f < kFingerBoneCount / 2;
      const int parent = kFingerBones[f].parent;
      const Quaterniond R_WP = parent >= 0
                                   ? R_WF[static_cast<std::size_t>(parent)]
                                   : R_WB[index_of(left ? Bone::kLeftHand : Bone::kRightHand)];
      R_WF[f] = R_WP;
      if (rig_.finger_of[f] != kNoJoint) {
        const auto joint = static_cast<std::size_t>(rig_.finger_of[f]);
        R_WF[f] = reference_.R_WF * figure_.R_FJ[joint] * finger_turn_[f];
      }
      set(hands.R_PB[f], R_WP.conjugate() * R_WF[f],
          frame > 0 ? &out_.clip.hands[frame - 1].R_PB[f] : nullptr);
    }
  }

  // q and −q are one rotation; the one nearer to the previous frame keeps the numbers smooth.
  static void set(Eigen::Quaternionf& out, const Quaterniond& q, const Eigen::Quaternionf* before) {
    out = q.normalized().cast<float>();
    if (before ? out.dot(*before) < 0.0f : out.w() < 0.0f) out.coeffs() = -out.coeffs();
  }

  void put_on_floor() {
    std::vector<float> lows;
    lows.reserve(out_.clip.frames.size());
    BodyFrames body;
    for (const Pose& pose : out_.clip.frames) {
      forward_kinematics(out_.clip.skeleton, pose, body);
      lows.push_back(
          std::min({body.position(Bone::kLeftFoot).y(), body.position(Bone::kRightFoot).y(),
                    body.position(Bone::kLeftToes).y(), body.position(Bone::kRightToes).y(),
                    body.tip(Tip::kLeftToes).y(), body.tip(Tip::kRightToes).y()}));
    }
    const auto rank =
        static_cast<std::ptrdiff_t>(kFloorPercentile * static_cast<double>(lows.size() - 1));
    std::nth_element(lows.begin(), lows.begin() + rank, lows.end());
    const float floor = lows[static_cast<std::size_t>(rank)];
    for (Pose& pose : out_.clip.frames) pose.p_WH_m.y() -= floor;
    char note[80];
    std::snprintf(note, sizeof note, "the floor was at %.3f m: moved to 0",
                  static_cast<double>(floor));
    if (std::abs(floor) > 0.005f) out_.notes.emplace_back(note);
  }

  const Bvh& bvh_;
  const Rig& rig_;
  const RetargetOptions& options_;
  const BvhMotion motion_;
  RigReference reference_;
  Retargeted out_;
  BvhFigure figure_;
  std::array<Quaterniond, kBoneCount> turn_;
  std::array<Quaterniond, kFingerBoneCount> finger_turn_;
  std::array<int, kBoneCount> aims_ = [] {
    std::array<int, kBoneCount> none;
    none.fill(-1);
    return none;
  }();
  std::uint32_t presence_ = kAllBones;
  std::uint32_t finger_presence_ = 0;
  bool has_hands_ = false;
};

}  // namespace

Result<Retargeted> retarget(const Bvh& bvh, const RetargetOptions& options) {
  if (bvh.frame_count == 0) return fail("no frames; the file holds a skeleton but no motion");
  if (bvh.channel_count == 0) return fail("no channels; the file's joints cannot move");
  if (options.metres_per_unit && !(*options.metres_per_unit > 0.0))
    return fail("metres per unit must be above 0");
  if (options.frame_hz && !(*options.frame_hz > 0.0))
    return fail("frames a second must be above 0");
  DANCE_TRY(const Rig rig, find_rig(bvh));
  return Retargeter(bvh, rig, options).run();
}

}  // namespace dance
