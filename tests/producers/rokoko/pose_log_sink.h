// A sink that keeps what a receiver captures, for tests.
//
// Ownership: keeps copies.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include <vector>

#include "producers/capture_sink.h"

namespace dance {

class PoseLogSink : public CaptureSink {
 public:
  void capture(const GuestId&, Pose& pose, MonoTime) override { poses.push_back(pose); }
  void capture(const GuestId&, const Hands& taken) override { hands.push_back(taken); }
  void capture(const GuestId&, const TimedSkeleton& timed) override {
    skeleton = timed.skeleton;
    ++skeletons;
  }

  std::vector<Pose> poses;
  std::vector<Hands> hands;
  Skeleton skeleton;
  int skeletons = 0;
};

}  // namespace dance
