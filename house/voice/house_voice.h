// HouseVoice: the voice of a house's session: a dance-voice program of its own beside the house: a
// sound server that hangs is nothing to the dancers. While the program has no sound, the house
// publishes VOICE_STATE in its place, without microphone and loudspeaker, for windows. A window can
// turn the voice on and off; when it goes off the others see the guest as deafened.
//
// Units/frames: none.
// Ownership:    owns the program, which ends with it; refers to the poller, which must outlive it,
//               and to the port, which must deliver nothing after its end.
// Threads:      none inside; runs in the poller's thread.
// Failure:      as house/program/hosted_program.h.
#pragma once

#include <memory>

#include "core/bus/signal_port.h"
#include "core/control/voice_switch.h"
#include "house/program/hosted_program.h"
#include "house/voice/hosted_voice.h"
#include "house/voice/voice_sign.h"

namespace dance {

class HouseVoice {
 public:
  // `bus` is the LCM URL of the bus of the port. Off where the session does not enable the voice.
  HouseVoice(const HostedVoice& voice, const std::string& bus, SignalPort& port, Poller& poller);
  HouseVoice(const HouseVoice&) = delete;
  HouseVoice& operator=(const HouseVoice&) = delete;
  ~HouseVoice();

  void turn(bool is_on);

 private:
  void open_switch(const std::string& bus);
  void report_silence(MonoTime now);

  GuestId guest_;
  SignalPort& port_;
  Poller& poller_;
  Poller::TimerId timer_ = 0;
  VoiceSign sign_;
  int reports_of_end_ = 0;  // still to be published
  MonoTime turned_on_;      // during the dance; not set: never
  HostedProgram program_;
  std::unique_ptr<ProgramControl> switch_;
};

}  // namespace dance
