// From a skeleton in a frame of NatNet to a figure and its fingers. Bones that are given in their
// parents are recognised by their places: those are then the offsets of the model.
//
// Units/frames: figure and hands in W; Motive's bones have no rotation in T-pose facing +Z.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      a bone that is not tracked is absent; hands_of() is false where no finger came.
#pragma once

#include "formats/natnet/natnet_rig.h"
#include "producers/receive/joint_figure.h"

namespace dance {

class NatNetBody {
 public:
  void set_rig(const NatNetRig& rig) { rig_ = rig; }
  const NatNetRig& rig() const { return rig_; }
  // Of the skeleton as it came; what figure() and hands() give is of this one.
  void take(const NatNetSkeleton& skeleton, bool z_is_up);
  const FigureFrame& figure() const { return figure_; }
  bool hands(Hands& hands) const;
  bool is_in_parents() const { return is_in_parents_; }

 private:
  struct Joint {
    Eigen::Vector3f p_m = Eigen::Vector3f::Zero();
    Eigen::Quaternionf R = Eigen::Quaternionf::Identity();
    bool is_tracked = false;
  };
  bool looks_in_parents() const;
  void make_global();

  NatNetRig rig_;
  std::array<Joint, kMostNatNetBones> joints_;
  FigureFrame figure_;
  bool is_in_parents_ = false;
};

}  // namespace dance
