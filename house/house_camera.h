// HouseCamera: the camera of a house's session: a dance-capture program of its own beside the
// house, so that a driver that hangs or a decoder that falls over is nothing to the stage and the
// line. It is started again when it dies.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house. A program that cannot be started is said; one that ends
//               because there is no camera (it has said the cure) is started again every ten
//               seconds, one that died a second later, then after longer and longer pauses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "house/session.h"

namespace dance {

// The words of `dance capture` for what a session says.
std::vector<std::string> camera_arguments(const HostedCamera& camera, const std::string& bus);

class HouseCamera {
 public:
  static std::unique_ptr<HouseCamera> open(const HostedCamera& camera, const std::string& bus,
                                           Poller& poller);
  ~HouseCamera();
  HouseCamera(const HouseCamera&) = delete;
  HouseCamera& operator=(const HouseCamera&) = delete;

 private:
  HouseCamera(const HostedCamera& camera, const std::string& bus, Poller& poller);
  Result<void> start();
  MonoTime look(MonoTime now);

  GuestId guest_;
  std::vector<std::string> arguments_;
  Poller& poller_;
  std::unique_ptr<ChildProcess> program_;
  Poller::TimerId watch_ = 0;
  bool is_down_ = false;
  bool has_said_missing_ = false;
  MonoTime started_;
  Duration pause_;
};

}  // namespace dance
