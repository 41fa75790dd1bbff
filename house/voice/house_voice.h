// HouseVoice: the voice of a house's session: a dance-voice program of its own beside the house: a
// sound server that hangs is nothing to the dancers. It is started again when it ends.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      nothing ends the house. What the program cannot have it says itself, once; it is
//               tried again every ten seconds, and that it works again is said too.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/net/poller.h"
#include "core/program/child_process.h"
#include "house/voice/hosted_voice.h"
#include "house/voice/program_words.h"

namespace dance {

class HouseVoice {
 public:
  static std::unique_ptr<HouseVoice> open(const HostedVoice& voice, const std::string& bus,
                                          Poller& poller);
  ~HouseVoice();
  HouseVoice(const HouseVoice&) = delete;
  HouseVoice& operator=(const HouseVoice&) = delete;

 private:
  HouseVoice(const HostedVoice& voice, const std::string& bus, Poller& poller);
  bool start();
  MonoTime look(MonoTime now);

  std::vector<std::string> arguments_;
  Poller& poller_;
  ProgramWords words_;
  std::unique_ptr<ChildProcess> program_;
  MonoTime started_;
  Poller::TimerId watch_ = 0;
  int last_exit_ = 0;  // of a failure that was said; 0 once it has worked
};

}  // namespace dance
