// VrchatWriter: a dancer's poses as the trackers that VRChat takes over OSC: where the joints are,
// as if the dancer wore a tracker at each, and the head, after which VRChat aligns the others. One
// packet a pose.
//
// Units/frames: poses and skeletons as core/pose has them; written as metres in Unity's axes and
//               angles as formats/osc/tracker_angles.h has them. A tracker has the rotation of the
//               bone that it would be strapped to; all angles are 0 in T-pose.
// Ownership:    refers to the sink, which must outlive it; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       VRChat's documentation, OSC trackers.
#pragma once

#include <array>

#include "core/pose/kinematics.h"
#include "formats/osc/osc_bundle_writer.h"
#include "formats/osc/tracker_angles.h"

namespace dance {

struct VrchatTracker {
  const char* position_address;
  const char* rotation_address;
  Bone joint;  // where it is
  Bone strap;  // which bone it turns with
};
constexpr std::size_t kVrchatTrackerCount = 9;
extern const std::array<VrchatTracker, kVrchatTrackerCount> kVrchatTrackers;

class VrchatWriter {
 public:
  explicit VrchatWriter(OscPacketSink& sink) : bundles_(sink) {}

  void set_skeleton(const Skeleton& skeleton) { skeleton_ = skeleton; }
  void write_pose(const Pose& pose);

 private:
  OscBundleWriter bundles_;
  Skeleton skeleton_ = average_skeleton();
  BodyFrames frames_;
  std::array<TrackerAngles, kVrchatTrackerCount> angles_;
};

}  // namespace dance
