// HouseCamera: the camera of a house's session: a dance-capture program of its own beside the
// house, so that a driver that hangs or a decoder that falls over is nothing to the stage and the
// line.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to port and poller, which must outlive
//               it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house; see HostedProgram. A program that has no camera has said so
//               and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/bus/signal_port.h"
#include "house/program/hosted_program.h"
#include "house/session.h"

namespace dance {

// The words of `dance capture` for what a session says.
std::vector<std::string> camera_arguments(const HostedCamera& camera, const std::string& bus);

class HouseCamera {
 public:
  // `bus` is the LCM URL of the bus of the port.
  HouseCamera(const HostedCamera& camera, const std::string& bus, SignalPort& port, Poller& poller);
  HouseCamera(const HouseCamera&) = delete;
  HouseCamera& operator=(const HouseCamera&) = delete;

 private:
  MonoTime newest_pose_;
  HostedProgram program_;
};

}  // namespace dance
