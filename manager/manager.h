// Manager: the signal manager of one house. Hears captures and remote guests on its port, routes
// them to the stage (at its steady rate, or as they come), keeps the roster and says once a second
// who is alive and what was counted. Four times a second it says at which tempo the dancers step,
// and sixty times who touches whom.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the port and the poller, which must outlive it.
// Threads:      runs in the poller's thread; one more learns the dancers
//               (manager/training_thread.h).
// Failure:      what cannot be routed is counted in STATS/manager.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/base/histogram.h"
#include "core/base/pacer.h"
#include "core/bus/signal_port.h"
#include "core/net/poller.h"
#include "manager/router.h"
#include "manager/training_thread.h"
#include "transformers/tempo/room_steps.h"
#include "transformers/touch/stage_touch.h"

namespace dance {

class Manager : private StageSink, private TouchSink {
 public:
  Manager(const std::vector<Route>& routes, SignalPort& port, Poller& poller);

  // Called once for each other manager on this bus: two fill one stage.
  void on_other_manager(std::function<void()> tell);

  Stats stats(MonoTime now);
  // Poses of dancers who had no place to hold hands and to touch, and touching pairs likewise.
  std::uint64_t without_touch() const { return router_.holds().refused() + touch_.refused(); }

 private:
  void stage(const GuestId& guest, Pose& pose, MonoTime now) override;
  void stage(const GuestId& guest, const Hands& hands) override;
  void stage(const GuestId& guest, const TimedSkeleton& skeleton) override;
  void on_touch(const GuestId& guest, const Touch& touch) override;
  void listen(Where where);
  void start_timers(Poller& poller);
  void end_second(MonoTime now);
  void repeat_skeletons(MonoTime now);
  void tell_settings(MonoTime now, const GuestId& only);
  void tell_steps(MonoTime now);

  // A body on the stage, repeated once a second for late subscribers.
  struct StagedSkeleton {
    GuestId guest;
    TimedSkeleton skeleton;
    MonoTime published;
  };

  SignalPort& port_;
  TrainingThread training_;
  Router router_;
  RoomSteps steps_;
  StageTouch touch_;
  std::vector<Pacer> pacers_;  // one per route
  Histogram lateness_;
  Duration lateness_p99_;
  MonoTime begin_;
  std::array<MonoTime, 8> others_begun_{};  // managers that were told of; the oldest gives way
  std::size_t others_ = 0;
  std::vector<StagedSkeleton> skeletons_;  // at most kMaxGuests
};

}  // namespace dance
