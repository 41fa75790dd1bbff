// StandingBody: where the bones of a dancer are who stands upright, in T-pose or as usual, with the
// devices at these places: the mounts lie between the two.
//
// Units/frames: W as tracker_frame.h; metres.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; wants the head among the places.
#pragma once

#include "core/pose/kinematics.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class StandingBody {
 public:
  enum class Arms : std::uint8_t { kStretched, kHang };

  StandingBody(const Skeleton& skeleton, const BonePlaces& devices,
               const Eigen::Quaternionf& R_WFacing, const Mount& head,
               Arms arms = Arms::kStretched);

  Place bone(TrackedPoint point) const;
  Eigen::Vector3f shoulder(TrackedPoint hand) const;
  Eigen::Vector3f wrist(TrackedPoint hand) const;

 private:
  Place foot(TrackedPoint point) const;
  Place thigh(TrackedPoint point) const;
  // Of the arm to this hand or elbow: stretched to where the hand is.
  Eigen::Quaternionf arm_turn(TrackedPoint point) const;

  BonePlaces devices_;
  Eigen::Quaternionf R_WFacing_;
  Arms arms_;
  float scale_;
  BodyFrames frames_;
};

}  // namespace dance
