// HouseHeadset: a headset of a house's session: a dance-headset program of its own beside the
// house, so that what a vendor's runtime does in its process is nothing to the stage and the line.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to port and poller, which must outlive
//               it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house; see HostedProgram. That the dancer has left with the
//               headset is told by has_left().
#pragma once

#include "core/bus/signal_port.h"
#include "house/headset/hosted_headset.h"
#include "house/program/hosted_program.h"

namespace dance {

class HouseHeadset {
 public:
  // `bus` is the LCM URL of the bus of the port.
  HouseHeadset(const HostedHeadset& headset, const std::string& bus, SignalPort& port,
               Poller& poller);
  HouseHeadset(const HouseHeadset&) = delete;
  HouseHeadset& operator=(const HouseHeadset&) = delete;

  // The program has ended by itself, without an error.
  bool has_left() const { return program_.has_finished(); }

 private:
  MonoTime newest_pose_;
  HostedProgram program_;
};

}  // namespace dance
