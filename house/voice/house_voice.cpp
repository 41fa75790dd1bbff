#include "house/voice/house_voice.h"

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr Duration kReportEvery = Duration::s(1);
// The program may publish a last state of its own while it ends.
constexpr int kReportsOfEnd = 3;

HostedProgram::Options voice_program(const HostedVoice& voice, const std::string& bus,
                                     const VoiceSign& sign) {
  HostedProgram::Options options;
  options.path = program_folder() + "/dance-voice";
  options.name = "dance voice";
  options.without = "without voices";
  options.starts = voice.enabled;
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
  open_switch(bus);
}

void HouseVoice::open_switch(const std::string& bus) {
  auto opened = open_voice_switch(
      bus, guest_, [this](bool is_on) { turn(is_on); }, poller_);
  if (opened)
    switch_ = std::move(*opened);
  else
    talk::warn("the voice of {} cannot be turned on and off: {}", guest_.view(),
               opened.error().what);
}

void HouseVoice::turn(bool is_on) {
  if (program_.is_wanted() == is_on) return;
  program_.set_wanted(is_on);
  reports_of_end_ = is_on ? 0 : kReportsOfEnd;
  turned_on_ = mono_now();
  if (!is_on) report_silence(turned_on_);
}

HouseVoice::~HouseVoice() { poller_.remove_timer(timer_); }

// Windows show the difference between a voice without sound and a guest without voice.
void HouseVoice::report_silence(MonoTime now) {
  const bool is_off = !program_.is_wanted();
  if (is_off ? reports_of_end_ == 0 : sign_.works(now)) return;
  const bool is_starting = turned_on_.is_set() && now - turned_on_ < VoiceSign::kSilent;
  if (!is_off && is_starting) return;
  if (is_off) --reports_of_end_;
  VoiceState state;
  state.time = now;
  state.clock_id = this_clock_id();
  state.is_heard = false;
  state.is_muted = state.is_deafened = is_off;
  state.has_microphone = state.has_loudspeaker = is_off;
  port_.publish(Where::kCapture, guest_, state);
}

}  // namespace dance
