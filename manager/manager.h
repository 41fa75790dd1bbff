// Manager: the signal manager of one house. Hears captures and remote guests on the bus (or from a
// link in the same process), routes them to the stage at its steady rate, keeps the roster and says
// once a second who is alive and what was counted.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the bus and the poller, which must outlive it.
// Threads:      runs in the poller's thread; one more learns the dancers (manager/study.h).
// Failure:      what cannot be routed is counted in STATS/manager.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/base/histogram.h"
#include "core/base/pacer.h"
#include "core/bus/bus.h"
#include "core/net/poller.h"
#include "manager/router.h"
#include "manager/study.h"

namespace dance {

struct ManagerOptions {
  std::vector<Route> routes;
  // False when a link in this process hands remote guests over directly: their copies on the bus
  // are then not heard.
  bool hear_guests_on_bus = true;
  // Captures that a producer in this process hands over directly, likewise.
  std::vector<GuestId> hosted_captures;
};

class Manager : private StageSink {
 public:
  Manager(ManagerOptions options, Bus& bus, Poller& poller);

  // From a link or a producer in this process.
  void take(Where where, const GuestId& guest, const Pose& pose, MonoTime now) {
    router_.take(where, guest, pose, now);
  }
  void take(Where where, const GuestId& guest, const Hands& hands) {
    router_.take(where, guest, hands);
  }
  void take(Where where, const GuestId& guest, const TimedSkeleton& skeleton) {
    router_.take(where, guest, skeleton);
  }

  // A consumer in this process: hears each staged pose and skeleton beside the bus.
  using OnStagedPose = std::function<void(const GuestId& guest, const Pose& pose, MonoTime now)>;
  using OnStagedSkeleton = std::function<void(const GuestId& guest, const Skeleton& skeleton)>;
  void on_staged(OnStagedPose on_pose, OnStagedSkeleton on_skeleton);

  // Called once for each other manager on this bus: two fill one stage, and nobody else would say
  // so.
  void on_other_manager(std::function<void()> tell);

  Stats stats(MonoTime now);

 private:
  void stage(const GuestId& guest, Pose& pose, MonoTime now) override;
  void stage(const GuestId& guest, const Hands& hands) override;
  void stage(const GuestId& guest, const TimedSkeleton& skeleton) override;
  bool is_hosted(Where where, const GuestId& guest) const;
  void listen(Where where);
  void start_timers(Poller& poller);
  void end_second(MonoTime now);
  void repeat_skeletons(MonoTime now);

  // A body on the stage, repeated once a second for whoever comes late.
  struct StagedSkeleton {
    GuestId guest;
    TimedSkeleton skeleton;
    MonoTime published;
  };

  ManagerOptions options_;
  Bus& bus_;
  Study study_;
  Router router_;
  std::vector<Pacer> pacers_;  // one per route
  Histogram lateness_;
  Duration lateness_p99_;
  MonoTime begin_;
  std::array<MonoTime, 8> others_begun_{};  // managers that were told of; the oldest gives way
  std::size_t others_ = 0;
  std::vector<StagedSkeleton> skeletons_;  // at most kMaxGuests
  std::vector<OnStagedPose> on_staged_pose_;
  std::vector<OnStagedSkeleton> on_staged_skeleton_;
};

}  // namespace dance
