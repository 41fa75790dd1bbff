// LandmarkSource: the points of each dancer of a camera, picture by picture: one dancer whom
// PoseEstimator tracks, or several whom PeopleEstimator tells apart.
//
// Units/frames: as producers/camera/body_landmarks.h says.
// Ownership:    owns its networks. What see() returns is good until the next call.
// Threads:      one owner; computes on the caller's thread alone.
// Failure:      open_landmark_source() names the file that is missing or damaged, and the cure.
#pragma once

#include <memory>
#include <span>

#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/people/people_estimator.h"

namespace dance {

class LandmarkSource {
 public:
  virtual ~LandmarkSource() = default;
  // Of each dancer, always in the same order; not smoothed, as the solver smooths too, and
  // smoothing twice would double the delay.
  virtual std::span<const BodyLandmarks> see(const Frame& frame) = 0;
  // The camera was unplugged: the next picture is searched.
  virtual void restart() = 0;
  // Of whole pictures.
  virtual std::uint64_t searches() const = 0;
  // With several dancers: each has only a turn of every n-th picture, where the load is too high.
  virtual void set_turns(std::size_t) {}
  // Whether this dancer had no turn in the last picture: the landmarks are older then.
  virtual bool is_left_out(std::size_t) const { return false; }
};

Result<std::unique_ptr<LandmarkSource>> open_landmark_source(const EstimatorOptions& options,
                                                             std::size_t dancers);

}  // namespace dance
