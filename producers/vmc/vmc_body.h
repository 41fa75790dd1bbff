// VmcBody: a dancer's pose, fingers and proportions from the frames of a VMC performer.
//
// Proportions are those that the bones' positions tell, where they are real; performers that know
// no body send zeros, and their dancer is an average one whose height the hips tell, which a
// standing dancer has highest. Where even the hips have no place, the feet stand on the floor.
//
// Units/frames: as core/pose has them; Root and hips together are the place in W.
// Ownership:    remembers proportions; never allocates.
// Threads:      none inside; one owner.
// Failure:      bones that did not come keep their last rotation and lack their bit of presence.
#pragma once

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "producers/vmc/vmc_assembler.h"

namespace dance {

class VmcBody {
 public:
  void take(const ReceivedVmcFrame& frame);

  const Pose& pose() const { return pose_; }
  const Skeleton& skeleton() const { return skeleton_; }
  // Fingers of this frame; presence is 0 where none came.
  const Hands& hands() const { return hands_; }
  bool has_own_proportions() const { return has_own_proportions_; }

 private:
  bool learn_proportions(const ReceivedVmcFrame& frame);
  void guess_height(float hips_height_m);
  void stand_on_the_floor();

  Pose pose_;
  Hands hands_;
  Skeleton skeleton_ = average_skeleton();
  float highest_hips_m_ = 0.0f;
  bool has_own_proportions_ = false;
};

}  // namespace dance
