// A capture sink that keeps what receivers publish.
//
// Units/frames: as core/pose has them.
// Ownership:    copies; KeptCaptures allocates, LastCapture does not.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "producers/capture_sink.h"

namespace dance {

class KeptCaptures : public CaptureSink {
 public:
  void capture(const GuestId& guest, Pose& pose, MonoTime) override {
    guests.push_back(guest);
    poses.push_back(pose);
  }
  void capture(const GuestId&, const Hands& fingers) override { hands.push_back(fingers); }
  void capture(const GuestId&, const TimedSkeleton& timed) override {
    skeletons.push_back(timed);
    poses_before_skeleton.push_back(poses.size());
  }
  std::vector<GuestId> guests;
  std::vector<Pose> poses;
  std::vector<Hands> hands;
  std::vector<TimedSkeleton> skeletons;
  std::vector<std::size_t> poses_before_skeleton;
};

class LastCapture : public CaptureSink {
 public:
  void capture(const GuestId&, Pose& pose, MonoTime) override {
    last = pose;
    ++count;
  }
  void capture(const GuestId&, const Hands&) override {}
  void capture(const GuestId&, const TimedSkeleton&) override {}
  Pose last;
  int count = 0;
};

}  // namespace dance
