// PalmWrist: turns the hands of a pose as their palms are seen. The body's network has two points
// of a hand beside the wrist, the hand's own network twenty. What the palm says goes onto the next
// pose as a turn of what the solver has, so that it neither delays a moving arm nor trembles.
//
// Units/frames: R_WHand is the hand bone's rotation in W.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a palm that is turned further from the solver's than wrists are is refused; the
//               turn fades where no palm is seen.
#pragma once

#include <optional>

#include "core/pose/pose.h"
#include "producers/camera/hands/hand_landmarks.h"

namespace dance {

class PalmWrist {
 public:
  // The palm, the solver's hand in the same picture, and HandLandmarks::trust().
  void see(HandSide side, const Eigen::Quaternionf& R_WPalm, const Eigen::Quaternionf& R_WHand,
           float trust, MonoTime now);
  // Half of the turn about the forearm is the forearm's.
  void apply(MonoTime now, Pose& pose) const;
  void reset() { sides_ = {}; }

 private:
  struct Side {
    std::optional<MonoTime> seen;  // last
    Eigen::Quaternionf turn = Eigen::Quaternionf::Identity();
  };
  std::array<Side, 2> sides_;
};

// The rotation of a bone in W.
Eigen::Quaternionf rotation_in_W(const Pose& pose, Bone bone);

}  // namespace dance
