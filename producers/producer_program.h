// What a producer that runs as a program of its own does: opens the bus, feeds its dancers into it
// by absolute deadlines, and ends when they are over, when its time is up or when it is told to.
//
// Units/frames: start_us counts in this machine's monotonic clock.
// Ownership:    owns bus, poller and dancers.
// Threads:      call from main before other threads are started.
// Failure:      open() names the bus and the cure.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/poller.h"
#include "core/program/command_line.h"
#include "producers/dancer_feed.h"

namespace dance {

struct ProducerOptions {
  std::string bus;
  double hz = 0.0;            // 0 = the dancer's own
  double seconds = 0.0;       // 0 = for ever
  std::int64_t start_us = 0;  // when the dance began or begins; 0 = now
};

void add_producer_options(CommandLine& line, ProducerOptions& options);

// Where a dancer is put on the stage: "x,z" or "x,z,heading", metres and degrees about +Y.
struct ProducerPlace {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
};
Result<ProducerPlace> parse_place(const std::string& text);

class ProducerProgram {
 public:
  static Result<std::unique_ptr<ProducerProgram>> open(const ProducerOptions& options);

  void add(std::unique_ptr<Dancer> dancer, const GuestId& guest);
  // Bus and houses.
  SignalPort& port() { return *port_; }
  Poller& poller() { return *poller_; }
  // The music of the house.
  const BeatClock& music() const { return sink_->captures().music(); }
  MonoTime start() const { return start_; }
  // Until all dancers are over and `is_over` says so too.
  void run(const std::function<bool()>& is_over);
  std::uint64_t sent() const;

 private:
  ProducerProgram() = default;
  ProducerOptions options_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<HousePublisher> port_;
  std::unique_ptr<PortCaptureSink> sink_;
  std::vector<std::unique_ptr<DancerFeed>> feeds_;
  MonoTime start_;
};

}  // namespace dance
