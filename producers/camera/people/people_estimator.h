// PeopleEstimator: from pictures to the points of two to four dancers' bodies: the networks of
// PoseEstimator, run once for each dancer, and PeopleTracker, which knows whose body it is.
//
// Units/frames: as producers/camera/body_landmarks.h says; times are those of the frames. The first
//               dancers are numbered from the left to the right of the picture.
// Ownership:    owns networks and memory. What estimate() returns is good until the next call.
// Threads:      one owner; computes on the caller's thread alone.
// Failure:      open() names the file that is missing or damaged, and the cure. A dancer who is not
//               seen, and all in a picture of another pixel format, have found == false.
#pragma once

#include <memory>

#include "producers/camera/frame.h"
#include "producers/camera/people/network_vision.h"
#include "producers/camera/people/people_tracker.h"

namespace dance {

class PeopleEstimator {
 public:
  static Result<std::unique_ptr<PeopleEstimator>> open(const EstimatorOptions& networks,
                                                       const PeopleOptions& people);

  // The landmarks of each, not smoothed. Without `reads` a dancer is left out of this picture: the
  // landmarks are those of the last one.
  std::span<const BodyLandmarks> estimate(const Frame& frame, const PeopleTracker::Reads& reads = {
                                                                  true, true, true, true});
  // Another camera, or another size: all are searched for.
  void reset() { tracker_.reset(); }
  // The camera was away: all are searched for, and known by their clothes.
  void lose_all() { tracker_.lose_all(); }

  const PeopleTracker& tracker() const { return tracker_; }

 private:
  PeopleEstimator(std::unique_ptr<NetworkVision> vision, const PeopleOptions& people)
      : vision_(std::move(vision)), tracker_(people) {}

  std::unique_ptr<NetworkVision> vision_;
  PeopleTracker tracker_;
  cv::Size picture_size_;
  std::array<BodyLandmarks, kMostDancers> landmarks_;
};

}  // namespace dance
