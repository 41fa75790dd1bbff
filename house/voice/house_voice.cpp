#include "house/voice/house_voice.h"

#include "core/net/mono_clock.h"
#include "core/program/program.h"

namespace dance {
namespace {

HostedProgram::Options voice_program(const HostedVoice& voice, const std::string& bus,
                                     const VoiceSign& sign) {
  HostedProgram::Options options;
  options.path = program_folder() + "/dance-voice";
  options.name = "dance voice";
  options.without = "without voices";
  options.arguments = [words = voice_arguments(voice, bus)] { return words; };
  options.works = [&sign](pid_t, MonoTime started) { return sign.works_since(started); };
  return options;
}

}  // namespace

HouseVoice::HouseVoice(const HostedVoice& voice, const std::string& bus, SignalPort& port,
                       Poller& poller)
    : sign_(this_clock_id()), program_(voice_program(voice, bus, sign_), poller) {
  port.subscribe<VoiceState>(
      {Where::kCapture, voice.guest},
      [this](const Channel&, const VoiceState& state, MonoTime now) { sign_.see(state, now); });
}

}  // namespace dance
