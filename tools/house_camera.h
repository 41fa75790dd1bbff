// HouseCamera: the camera of a house's session: a dance-capture program of its own beside the house, so that a driver that hangs or a
// decoder that falls over is nothing to the stage and the line. It is started again when it dies.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names a program that cannot be started; its later ends are said. One that ends with a message about the camera
//               or the models (exit 1 or 2) is not started again: it has said the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "manager/session.h"
#include "tools/child_process.h"

namespace dance {

// The words of `dance capture` for what a session says.
std::vector<std::string> camera_arguments(const HostedCamera& camera, const std::string& bus);

class HouseCamera {
 public:
  static Result<std::unique_ptr<HouseCamera>> open(const HostedCamera& camera,
                                                   const std::string& bus, Poller& poller);
  ~HouseCamera();
  HouseCamera(const HouseCamera&) = delete;
  HouseCamera& operator=(const HouseCamera&) = delete;

  pid_t pid() const { return program_->pid(); }

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
};

}  // namespace dance
