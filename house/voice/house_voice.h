// HouseVoice: the voice of a house's session: a dance-voice program of its own beside the house: a
// sound server that hangs is nothing to the dancers. While the program has no sound, the house
// publishes VOICE_STATE in its place, without microphone and loudspeaker, for windows.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it,
//               and to the port, which must deliver nothing after its end.
// Threads:      none inside; runs in the poller's thread.
// Failure:      as house/program/hosted_program.h.
#pragma once

#include "core/bus/signal_port.h"
#include "house/program/hosted_program.h"
#include "house/voice/hosted_voice.h"
#include "house/voice/voice_sign.h"

namespace dance {

class HouseVoice {
 public:
  // `bus` is the LCM URL of the bus of the port.
  HouseVoice(const HostedVoice& voice, const std::string& bus, SignalPort& port, Poller& poller);
  HouseVoice(const HouseVoice&) = delete;
  HouseVoice& operator=(const HouseVoice&) = delete;
  ~HouseVoice();

 private:
  void report_silence(MonoTime now);

  GuestId guest_;
  SignalPort& port_;
  Poller& poller_;
  Poller::TimerId timer_ = 0;
  VoiceSign sign_;
  HostedProgram program_;
};

}  // namespace dance
