// JointFigure: makes a dancer of a figure whose joints come with places and rotations in W, as
// motion capture systems send them: learns the skeleton from the places, and gives each frame's
// pose.
//
// Units/frames: metres in W; a joint's rotation is the identity in T-pose facing +Z.
// Ownership:    plain values; never allocates.
// Threads:      none inside; one owner.
// Failure:      fit() is false without hips, head, arms or legs. Other joints that are missing keep
//               their parent's rotation.
// Source:       two joints for the spine are common: then the chest, which bends between them, is
//               placed where two bones of constant length meet, on the side to which the trunk
//               bends: the joints that came stay where they are.
#pragma once

#include <array>
#include <cstdint>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

struct FigureFrame {
  std::array<Eigen::Vector3f, kBoneCount> p_WB_m;
  BoneRotations R_WB = identity_rotations();
  std::uint32_t presence = 0;  // a bit for each bone whose joint came
  std::array<Eigen::Vector3f, kTipCount> p_WT_m;
  std::uint32_t tip_presence = 0;

  bool has(Bone bone) const { return (presence >> index_of(bone) & 1u) != 0; }
  void put(Bone bone, const Eigen::Vector3f& p_m, const Eigen::Quaternionf& R) {
    p_WB_m[index_of(bone)] = p_m;
    R_WB[index_of(bone)] = R;
    presence |= 1u << index_of(bone);
  }
  void put_tip(Tip tip, const Eigen::Vector3f& p_m) {
    p_WT_m[static_cast<std::size_t>(tip)] = p_m;
    tip_presence |= 1u << static_cast<std::size_t>(tip);
  }
};

class JointFigure {
 public:
  // What the sender says of the body; 0: nothing.
  void set_heights(float total_m, float hips_m) {
    total_m_ = total_m;
    hips_m_ = hips_m;
  }

  // Fills the pose's rotations, hips and presence.
  bool fit(FigureFrame frame, Pose& pose);
  const Skeleton& skeleton() const { return skeleton_; }

 private:
  void complete_spine(FigureFrame& frame);
  void complete_others(FigureFrame& frame) const;
  void place_chest(FigureFrame& frame);
  bool is_placed(std::size_t bone) const;
  void learn(const FigureFrame& frame);
  void learn_offset(std::size_t bone, const Eigen::Vector3f& offset_m);
  void learn_tips(const FigureFrame& frame);
  void learn_tip(std::size_t tip, const Eigen::Vector3f& p_m);

  Skeleton average_ = average_skeleton();
  Skeleton skeleton_ = average_;
  std::array<Eigen::Vector3f, kBoneCount> mean_m_;
  std::array<int, kBoneCount> samples_{};
  float spine_length_m_ = 0.0f;  // the longest from spine to upper chest
  bool chest_is_placed_ = false;
  bool has_begun_ = false;
  float total_m_ = 0.0f;
  float hips_m_ = 0.0f;
};

}  // namespace dance
