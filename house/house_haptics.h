// HouseHaptics: a device of a house's session that is to be felt to the millisecond: a
// dance-haptics program of its own beside the house, at real-time priority, which the house itself
// must not have. It is started again when it ends.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house. What the program cannot have it says itself, once; it is
//               tried again every ten seconds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "house/session.h"

namespace dance {

class HouseHaptics {
 public:
  static std::unique_ptr<HouseHaptics> open(const HostedHaptics& haptics, const std::string& bus,
                                            Poller& poller);
  ~HouseHaptics();
  HouseHaptics(const HouseHaptics&) = delete;
  HouseHaptics& operator=(const HouseHaptics&) = delete;

 private:
  HouseHaptics(const HostedHaptics& haptics, const std::string& bus, Poller& poller);
  bool start();
  MonoTime look(MonoTime now);

  GuestId guest_;
  std::vector<std::string> arguments_;
  Poller& poller_;
  std::unique_ptr<ChildProcess> program_;
  Poller::TimerId watch_ = 0;
  int last_exit_ = 0;
};

}  // namespace dance
