// HouseMusic: the music of a house's session, played by a dance-music program of its own beside the
// house: a sound server that hangs is nothing to the dancers.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      open() names a program that cannot be started; its end is said, and the house goes
//               on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "house/session.h"

namespace dance {

// The words of `dance music` for what a session says.
std::vector<std::string> music_arguments(const HostedMusic& music, const std::string& bus);

class HouseMusic {
 public:
  static Result<std::unique_ptr<HouseMusic>> open(const HostedMusic& music, const std::string& bus,
                                                  Poller& poller);
  ~HouseMusic();
  HouseMusic(const HouseMusic&) = delete;
  HouseMusic& operator=(const HouseMusic&) = delete;

 private:
  HouseMusic(ChildProcess program, Poller& poller);

  ChildProcess program_;
  Poller& poller_;
  Poller::TimerId watch_;
};

}  // namespace dance
