// TrackerCalibration: finds how tall a dancer is, how long the arms are, and where each device sits
// on its bone: from a second in T-pose, or from walking about. It watches every frame; what it
// found are plain values that can be kept and restored.
//
// Units/frames: as tracker_frame.h and tracker_mounts.h; times are those of the frames.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Until anything is found the body is of average height; points other than head
//               and hands count as not tracked. restore() refuses values that cannot be true.
// Source:       eye height and segment lengths against body height: Winter (2009), as
//               core/pose/skeleton.h.
#pragma once

#include "core/pose/skeleton.h"
#include "producers/trackers/calibration/still_window.h"
#include "producers/trackers/calibration/usual_posture.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

enum class CalibrationState : std::uint8_t {
  kNeedsTPose,   // head and hands by their usual mounts, others not used
  kFromWalking,  // good enough to dance; a T-pose is better
  kFromTPose,
};

struct CalibrationValues {
  CalibrationState state = CalibrationState::kNeedsTPose;
  float height_m = 1.72f;
  float arm_ratio = 1.0f;  // length of the arms against that of an average body of this height
  std::array<Mount, kTrackedPointCount> mounts;
};

bool is_valid(const CalibrationValues& values);

// The body that these values say: average proportions, arms as found.
Skeleton skeleton_of(const CalibrationValues& values);

class TrackerCalibration {
 public:
  TrackerCalibration();

  // The next moment of standing in T-pose within a minute counts, also where one was found before.
  // Where no hand is seen all the while, standing upright is enough. Not needed for the first: arms
  // stretched out are recognised.
  void request_t_pose();
  // A valid frame, each once. Returns whether the values changed.
  bool observe(const TrackerFrame& frame);

  const CalibrationValues& values() const { return values_; }
  CalibrationState state() const { return values_.state; }
  bool awaits_t_pose() const { return is_requested_; }
  // How much of the second in T-pose has passed, 0 … 1.
  float t_pose_progress() const;

  // Returns false, and changes nothing, where the values are not valid.
  bool restore(const CalibrationValues& values);
  void reset();

  // Where the bones are that a frame tells of.
  void place_bones(const TrackerFrame& frame, BonePlaces& bones) const;

 private:
  void follow_request(const TrackerFrame& frame);
  bool is_t_pose(const StillWindow& still) const;
  void take_t_pose(const StillWindow& still);
  void take_arms(const StillWindow& still, const Eigen::Quaternionf& R_WFacing);
  bool take_height(const TrackerFrame& frame);
  bool take_usual_posture();
  void set_height(float height_m);

  CalibrationValues values_;
  StillWindow still_;
  UsualPosture usual_;
  bool is_requested_ = false, hands_seen_ = false;  // since it was
  MonoTime requested_;
  bool is_height_known_ = false;
  int postures_taken_ = 0;
};

}  // namespace dance
