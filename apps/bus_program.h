// BusProgram: the frame of a program that listens to a bus: the poll loop, the bus in it, an end
// by signal or after a number of seconds.
//
// Ownership: owns the loop and the bus; the bus's handlers must outlive it.
// Threads:   one.
// Failure:   open() names what could not be had and the cure.
#pragma once

#include <memory>
#include <string>

#include "core/base/result.h"
#include "core/bus/bus.h"
#include "core/net/poller.h"

namespace dance {

class BusProgram {
 public:
  static Result<BusProgram> open(const std::string& bus_url);

  Bus& bus() { return *bus_; }
  Poller& poller() { return *poller_; }
  // Ends run() after so many seconds; 0 = only a signal ends it.
  void stop_after(double seconds);
  // Calls `work` at `period` from now on.
  void every(Duration period, std::function<void(MonoTime now)> work);
  void run();

 private:
  BusProgram() = default;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_;
};

}  // namespace dance
