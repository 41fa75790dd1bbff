// XrDancer: the pose of a headset's dancer at one moment, from all that its sensors tell: a body
// where the headset sees a whole one, else a whole one from the points that are tracked.
//
// Units/frames: as core/pose/pose.h.
// Ownership:    owns the solvers; never allocates after it was made.
// Threads:      none inside; one owner. Two of one dancer, as one for the network and one for the
//               display, share what was found of the body by values().
// Failure:      solve() is false where nothing is known: without a head.
#pragma once

#include "core/motion/inertializer.h"
#include "producers/receive/joint_figure.h"
#include "producers/trackers/tracker_body.h"
#include "producers/xr/xr_sensors.h"

namespace dance {

class XrDancer {
 public:
  explicit XrDancer(const TrackerBody::Options& options) : body_(options) {}

  bool solve(const XrSight& sight, Pose& pose);
  // Of the pose solved last.
  const Skeleton& skeleton() const { return is_figure_ ? figure_.skeleton() : body_.skeleton(); }
  TrackerBody& body() { return body_; }
  const CalibrationValues& values() const { return body_.calibration().values(); }

 private:
  // A body that is not seen for so long is waited for; then the points take over, and back.
  static constexpr Duration kWaitsForBody = Duration::ms(300);

  bool find(const XrSight& sight, Pose& pose);

  TrackerBody body_;
  JointFigure figure_;
  bool is_figure_ = false, has_solved_ = false;
  MonoTime figure_seen_;
  Pose last_;  // as solved, without what the bridge adds
  Inertializer bridge_;
};

}  // namespace dance
