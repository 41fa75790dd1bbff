#include "house/voice/house_voice.h"

#include "core/net/mono_clock.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr Duration kReportEvery = Duration::s(1);

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
    : guest_(voice.guest),
      port_(port),
      poller_(poller),
      sign_(this_clock_id()),
      program_(voice_program(voice, bus, sign_), poller) {
  port.subscribe<VoiceState>(
      {Where::kCapture, voice.guest},
      [this](const Channel&, const VoiceState& state, MonoTime now) { sign_.see(state, now); });
  timer_ = poller.add_timer(mono_now() + VoiceSign::kSilent, [this](MonoTime now) {
    report_silence(now);
    return now + kReportEvery;
  });
}

HouseVoice::~HouseVoice() { poller_.remove_timer(timer_); }

// Windows show the difference between a voice without sound and a guest without voice.
void HouseVoice::report_silence(MonoTime now) {
  if (sign_.works(now)) return;
  VoiceState state;
  state.time = now;
  state.clock_id = this_clock_id();
  state.is_heard = state.has_microphone = state.has_loudspeaker = false;
  port_.publish(Where::kCapture, guest_, state);
}

}  // namespace dance
