// TrackerBody: a whole body from few tracked points: any of those in tracker_frame.h with a head
// among them. It calibrates itself, shows head and hands where they are measured, and goes on where
// a point is lost. A guide guesses what is not measured: by rules, or by a network that was trained
// on dances (`dance trackers train`).
//
// Units/frames: as tracker_frame.h and core/pose/pose.h. Any rate of frames; times need not be
//               even.
// Ownership:    owns its state; never allocates after it was made.
// Threads:      none inside; one owner.
// Failure:      solve() is false, and changes nothing, for a frame that is not valid, that has no
//               head, or that is no newer than the one before.
#pragma once

#include <memory>

#include "producers/trackers/body/body_fit.h"
#include "producers/trackers/body/mount_refiner.h"
#include "producers/trackers/body/place_smoother.h"
#include "producers/trackers/net/tracker_model.h"
#include "producers/trackers/tracker_calibration.h"

namespace dance {

enum class TrackerGuide : std::uint8_t {
  kAutomatic,  // the one that is better for the points that there are
  kGeometric,
  kLearned,
};

class TrackerBody {
 public:
  struct Options {
    TrackerGuide guide = TrackerGuide::kAutomatic;
    std::shared_ptr<const TrackerModel> model = nullptr;  // null: the built-in one
  };

  TrackerBody() : TrackerBody(Options()) {}
  explicit TrackerBody(const Options& options);
  ~TrackerBody();
  TrackerBody(TrackerBody&&) noexcept;
  TrackerBody& operator=(TrackerBody&&) noexcept;

  // Rotations, hips, capture time (the frame's) and confidence of the pose; all else is left.
  bool solve(const TrackerFrame& frame, Pose& pose);

  // Its version counts changes of the body.
  const Skeleton& skeleton() const { return skeleton_; }
  const TrackerCalibration& calibration() const { return calibration_; }
  // See TrackerCalibration.
  void request_t_pose() { calibration_.request_t_pose(); }
  bool restore(const CalibrationValues& values);
  // Another dancer, or the same one anew: nothing is known.
  void reset();

 private:
  void take_body();
  void forget_motion();

  Options options_;
  TrackerCalibration calibration_;
  Skeleton skeleton_;
  std::unique_ptr<BodyGuide> guide_;
  TrackerBodyFit fit_;
  std::array<PlaceSmoother, kTrackedPointCount> smoothers_;
  MountRefiner refiner_;
  BodyGuess guess_;
  MonoTime newest_;
};

}  // namespace dance
