#include "producers/receive/joint_figure.h"

#include <algorithm>
#include <cmath>

#include "core/pose/shortest_turn.h"

namespace dance {
namespace {

using Eigen::Quaterniond;
using Eigen::Quaternionf;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Beyond this a body's measures have changed, or it is another's: learnt anew.
constexpr float kOtherBody_m = 0.05f;
// A joint of the skeleton is told again when its mean has moved by more. Mocap's noise of a
// millimetre moves means of few samples by as much.
constexpr float kWorthTelling_m = 0.003f;
// Of bones that are placed here and have no noise of their own.
constexpr float kWorthPlacing_m = 0.00002f;
constexpr int kMostSamples = 240;
// Of the way from spine to upper chest that lies below the chest; as average_skeleton().
constexpr float kBelowChest = 0.479f;

std::size_t parent_of(std::size_t bone) { return static_cast<std::size_t>(kBones[bone].parent); }

// What no dancer can do without. Spine, neck, shoulders, hands, feet and toes may be missing.
constexpr std::array kRequired{
    Bone::kHips,          Bone::kHead,          Bone::kLeftUpperArm, Bone::kLeftLowerArm,
    Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kLeftUpperLeg, Bone::kLeftLowerLeg,
    Bone::kRightUpperLeg, Bone::kRightLowerLeg,
};

}  // namespace

bool JointFigure::fit(FigureFrame frame, Pose& pose) {
  for (const Bone bone : kRequired)
    if (!frame.has(bone)) return false;
  pose.presence = frame.presence;
  if (frame.has(Bone::kSpine) && frame.has(Bone::kUpperChest))
    pose.presence |= 1u << index_of(Bone::kChest);
  complete_spine(frame);
  complete_others(frame);
  learn(frame);
  pose.p_WH_m = frame.p_WB_m[0];
  pose.R_PB[0] = frame.R_WB[0];
  for (std::size_t b = 1; b < kBoneCount; ++b)
    pose.R_PB[b] = (frame.R_WB[parent_of(b)].conjugate() * frame.R_WB[b]).normalized();
  has_begun_ = true;
  return true;
}

void JointFigure::complete_spine(FigureFrame& frame) {
  if (frame.has(Bone::kChest) && !frame.has(Bone::kUpperChest)) {
    frame.put(Bone::kUpperChest, frame.p_WB_m[index_of(Bone::kChest)],
              frame.R_WB[index_of(Bone::kChest)]);
    frame.presence &= ~(1u << index_of(Bone::kChest));
  }
  if (!frame.has(Bone::kSpine)) {
    const Quaternionf& R = frame.R_WB[0];
    const float scale = frame.has(Bone::kUpperChest) ? 0.3f : 0.2f;
    const Bone above = frame.has(Bone::kUpperChest) ? Bone::kUpperChest : Bone::kHead;
    const Vector3f to = frame.p_WB_m[index_of(above)] - frame.p_WB_m[0];
    frame.put(Bone::kSpine, frame.p_WB_m[0] + scale * to.norm() * (R * Vector3f::UnitY()), R);
  }
  if (!frame.has(Bone::kUpperChest)) {
    const Quaternionf& R = frame.R_WB[index_of(Bone::kSpine)];
    const Vector3f& spine = frame.p_WB_m[index_of(Bone::kSpine)];
    const Bone above = frame.has(Bone::kNeck) ? Bone::kNeck : Bone::kHead;
    frame.put(
        Bone::kUpperChest,
        spine + 0.6f * (frame.p_WB_m[index_of(above)] - spine).norm() * (R * Vector3f::UnitY()), R);
  }
  chest_is_placed_ = !frame.has(Bone::kChest);
  if (chest_is_placed_) place_chest(frame);
}

// Two bones, as long together as spine and upper chest have ever been apart, meet at the chest.
void JointFigure::place_chest(FigureFrame& frame) {
  const Vector3d spine = frame.p_WB_m[index_of(Bone::kSpine)].cast<double>();
  const Vector3d upper = frame.p_WB_m[index_of(Bone::kUpperChest)].cast<double>();
  const Quaterniond R_spine = frame.R_WB[index_of(Bone::kSpine)].cast<double>();
  const Quaterniond R_upper = frame.R_WB[index_of(Bone::kUpperChest)].cast<double>();
  const double apart = (upper - spine).norm();
  if (apart < 1e-4) {
    frame.put(Bone::kChest, frame.p_WB_m[index_of(Bone::kSpine)],
              frame.R_WB[index_of(Bone::kSpine)]);
    return;
  }
  const auto apart_m = static_cast<float>(apart);
  if (apart_m > spine_length_m_ + kWorthPlacing_m || apart_m < 0.7f * spine_length_m_)
    spine_length_m_ = apart_m;
  const Vector3d chord = (upper - spine) / apart;
  const double length = std::max(apart, static_cast<double>(spine_length_m_));
  const double below = kBelowChest * length, above = length - below;
  // Bent about the axis about which the chest is turned against the hips.
  const Quaterniond turn = R_upper * frame.R_WB[0].cast<double>().conjugate();
  Vector3d axis = turn.w() < 0.0 ? Vector3d(-turn.vec()) : Vector3d(turn.vec());
  axis -= chord * chord.dot(axis);
  if (axis.norm() < 1e-6) axis = chord.unitOrthogonal();
  axis.normalize();
  const double cosine = std::clamp(
      (below * below + apart * apart - above * above) / (2.0 * below * apart), -1.0, 1.0);
  const Eigen::AngleAxisd back(-std::acos(cosine), axis);
  const Vector3d chest = spine + below * (back * chord);
  // Turned so that both bones lie in their parents as an average body's do: whatever rotation
  // came, the skeleton remains the same.
  const auto along = [&](Bone bone, const Vector3d& to) {
    const Vector3d in_parent = average_.offset(bone).cast<double>().normalized();
    return shortest_turn(R_spine * in_parent, to.normalized()) * R_spine;
  };
  const Quaterniond lower = along(Bone::kChest, chest - spine);
  const Quaterniond higher = along(Bone::kUpperChest, upper - chest);
  frame.R_WB[index_of(Bone::kSpine)] = lower.cast<float>();
  frame.put(Bone::kChest, chest.cast<float>(), higher.cast<float>());
}

// A joint that did not come is where its parent holds it.
void JointFigure::complete_others(FigureFrame& frame) const {
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    if ((frame.presence >> b & 1u) != 0) continue;
    const Quaternionf& R = frame.R_WB[parent_of(b)];
    Vector3f p_m = frame.p_WB_m[parent_of(b)] + R * skeleton_.offset_m[b];
    // Shoulders and neck lie on the way to what came.
    const Bone bone = static_cast<Bone>(b);
    const Bone next = bone == Bone::kNeck            ? Bone::kHead
                      : bone == Bone::kLeftShoulder  ? Bone::kLeftUpperArm
                      : bone == Bone::kRightShoulder ? Bone::kRightUpperArm
                                                     : Bone::kHips;
    if (next != Bone::kHips) {
      const float share = bone == Bone::kNeck ? 0.6f : 0.25f;
      p_m = frame.p_WB_m[parent_of(b)] +
            share * (frame.p_WB_m[index_of(next)] - frame.p_WB_m[parent_of(b)]);
    }
    frame.put(bone, p_m, R);
  }
}

bool JointFigure::is_placed(std::size_t bone) const {
  return chest_is_placed_ &&
         (bone == index_of(Bone::kChest) || bone == index_of(Bone::kUpperChest));
}

void JointFigure::learn_offset(std::size_t bone, const Vector3f& offset_m) {
  Vector3f& mean = mean_m_[bone];
  int& samples = samples_[bone];
  if (samples == 0 || is_placed(bone) || (offset_m - mean).norm() > kOtherBody_m) {
    mean = offset_m;
    samples = 1;
  } else {
    samples = std::min(samples + 1, kMostSamples);
    mean += (offset_m - mean) / static_cast<float>(samples);
  }
  const float worth_telling_m = is_placed(bone) ? kWorthPlacing_m : kWorthTelling_m;
  if (!has_begun_ || (mean - skeleton_.offset_m[bone]).norm() > worth_telling_m)
    skeleton_.offset_m[bone] = mean;
}

// offset_B = R_WPᵀ (p_WB − p_WP)
void JointFigure::learn(const FigureFrame& frame) {
  std::array<Vector3f, kBoneCount> offsets_m;
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const std::size_t p = parent_of(b);
    offsets_m[b] = frame.R_WB[p].conjugate() * (frame.p_WB_m[b] - frame.p_WB_m[p]);
    if (samples_[b] > 0 && !is_placed(b) && (offsets_m[b] - mean_m_[b]).norm() > kOtherBody_m)
      samples_.fill(0);
  }
  for (std::size_t b = 1; b < kBoneCount; ++b) learn_offset(b, offsets_m[b]);
  learn_tips(frame);
}

// And the hips' height, which hangs on the toes, and what stands on that.
void JointFigure::learn_tips(const FigureFrame& frame) {
  const float scale = std::clamp(
      skeleton_.offset(Bone::kLeftLowerLeg).norm() / average_.offset(Bone::kLeftLowerLeg).norm(),
      0.3f, 3.0f);
  for (std::size_t t = 1; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    Vector3f tip = scale * average_.tip_m[t];
    if ((frame.tip_presence >> t & 1u) != 0)
      tip = frame.R_WB[b].conjugate() * (frame.p_WT_m[t] - frame.p_WB_m[b]);
    learn_tip(t, tip);
  }
  // In T-pose the soles are on the floor.
  float hips_m = hips_m_;
  if (hips_m <= 0.0f) {
    for (const Bone bone : {Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot})
      hips_m -= skeleton_.offset(bone).y();
    hips_m -=
        std::min(skeleton_.offset(Bone::kLeftToes).y() + skeleton_.tip(Tip::kLeftToes).y(), -0.04f);
  }
  if (!has_begun_ || std::abs(hips_m - skeleton_.offset_m[0].y()) > kWorthTelling_m)
    skeleton_.offset_m[0] = {0.0f, hips_m, 0.0f};
  // And the top of the head is as high as the body.
  Vector3f top = scale * average_.tip_m[0];
  if ((frame.tip_presence & 1u) != 0)
    top = frame.R_WB[index_of(Bone::kHead)].conjugate() *
          (frame.p_WT_m[0] - frame.p_WB_m[index_of(Bone::kHead)]);
  if (total_m_ > 0.0f) {
    const float head_m = standing_height_m(skeleton_) - skeleton_.tip_m[0].y();
    top = {0.0f, std::clamp(total_m_ - head_m, 0.05f, 0.5f), 0.0f};
  }
  learn_tip(0, top);
}

void JointFigure::learn_tip(std::size_t tip, const Vector3f& p_m) {
  if (!has_begun_ || (p_m - skeleton_.tip_m[tip]).norm() > kWorthTelling_m)
    skeleton_.tip_m[tip] = p_m;
}

}  // namespace dance
