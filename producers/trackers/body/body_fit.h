// TrackerBodyFit: a whole body that is where it was measured, and elsewhere as a guide has guessed:
// the spine bends until the head is in its place, arms and legs reach hands and feet, feet that
// stand stay, and no foot goes below the floor. Points that are lost fade to the guess, and back.
//
// Units/frames: W, metres, the floor at 0.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Where a limb is too short for what was measured it stretches towards it; a
//               measured hip yields to the head.
// Source:       the spine by damped least squares (Wampler, 1986; Nakamura and Hanafusa, 1986).
#pragma once

#include "producers/trackers/body/body_guide.h"
#include "producers/trackers/body/foot_hold.h"
#include "producers/trackers/body/point_fade.h"

namespace dance {

class TrackerBodyFit {
 public:
  void reset() { *this = TrackerBodyFit(); }

  // `mounts_changed`: worn points are on their bones elsewhere than in the call `seconds` ago.
  void fit(const Skeleton& skeleton, const BodyGuess& guess, const BonePlaces& bones,
           bool mounts_changed, float seconds, Pose& pose);

 private:
  struct Step {
    const Skeleton& skeleton;
    const BodyGuess& guess;
    const BonePlaces& bones;
    float seconds;
    bool points_changed, mounts_changed;
    BodyFrames frames;
  };

  Place follow(const Step& step, TrackedPoint point, const Place& guessed);
  void fit_trunk(Step& step);
  void fit_arm(Step& step, bool left);
  void fit_leg(Step& step, std::size_t side);
  Place foot_goal(Step& step, std::size_t side, const Eigen::Vector3f& hip);

  std::array<PointFade, kTrackedPointCount> fades_;
  std::array<FootHold, 2> holds_;
  std::uint32_t presence_ = 0;
};

}  // namespace dance
