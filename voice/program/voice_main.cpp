// dance voice: speak with the others in the room, and hear them where their dancers stand.

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>

#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "core/program/foreground.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "voice/program/key_reader.h"
#include "voice/program/meter_line.h"
#include "voice/program/voice_program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance voice --guest alice                         speaks as alice, and hears the others
  dance voice --guest alice --to-headphones         without echo cancellation: nothing that is
                                                    played comes back
  dance voice --guest alice --push-to-talk          heard while the space bar is held
  dance voice --guest alice --volume bob=0.5 --with-picture
                                                    bob at half, and each voice as late as its
                                                    dancer is shown
  dance voice set --guest alice --mute              from another terminal, while it runs
  dance voice --guest alice --to-headphones --reference room-speakers
                                                    voices in a headset, and the music that this
                                                    sink plays is taken out
Keys: space talks (push to talk), m mutes, d deafens. In dance view: B, U and J.
)";

constexpr int kVoiceNice = -11;  // as sound servers have

struct VoiceOptions {
  std::string guest;
  std::string bus;
  std::string microphone, loudspeaker, reference;
  std::vector<std::string> volumes;
  VoiceSettings settings;  // with the volumes
  bool to_headphones = false, no_echo_cancellation = false, no_cleaning = false;
  bool push_to_talk = false, mute = false, deafen = false, with_picture = false, at_once = false;
  bool low_delay = false, json = false, quiet = false;
  double buffer_ms = 20.0;
  double bitrate_kbit = 32.0;
  double seconds = 0.0;
};

VoiceProgramOptions program_options(const VoiceOptions& options) {
  VoiceProgramOptions program;
  program.settings = options.settings;
  program.guest = *GuestId::parse(options.guest);
  program.bus = options.bus;
  program.devices.microphone = options.microphone;
  program.devices.loudspeaker = options.loudspeaker;
  program.devices.ahead = Duration::seconds(options.buffer_ms * 1e-3);
  // Into headphones goes no echo, but another sink may be named, as that of the room's music.
  const bool has_echo =
      !options.no_echo_cancellation && (!options.to_headphones || !options.reference.empty());
  program.devices.has_reference = has_echo;
  program.devices.reference = options.reference;
  program.cleaning.takes_out_echo = has_echo;
  program.cleaning.takes_out_noise = !options.no_cleaning;
  program.cleaning.levels_loudness = !options.no_cleaning;
  program.encoding.bits_per_second = static_cast<int>(options.bitrate_kbit * 1000.0);
  if (options.low_delay) {
    program.encoding.mode = VoiceMode::kLowDelay;
    program.encoding.has_error_correction = false;
  }
  program.settings.is_muted = options.mute;
  program.settings.is_deafened = options.deafen;
  program.settings.is_push_to_talk = options.push_to_talk;
  program.settings.follows_picture = options.with_picture;
  return program;
}

void on_key(VoiceProgram& program, char key, MonoTime now) {
  if (key == ' ') program.command("talk", now);
  if (key == 'm') program.command(program.settings().is_muted ? "unmute" : "mute", now);
  if (key == 'd') program.command(program.settings().is_deafened ? "undeafen" : "deafen", now);
}

Result<void> run_voice(const VoiceOptions& options) {
  VoiceProgramOptions wanted = program_options(options);
  // With --quiet another program may have started this one: its terminal is not ours.
  wanted.has_keys = !options.quiet && is_in_foreground();
  MeterLine line(STDERR_FILENO);
  wanted.before_words = [&line] { line.clear(); };
  // Sound that is late is a gap. Where the user may not have it (ulimit -e), it goes without.
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, kVoiceNice));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto bus, Bus::open(options.bus));
  HousePublisher port(*bus, bus->url(), *poller);
  DANCE_TRY(auto program, VoiceProgram::open(wanted, port, *poller));
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  std::optional<KeyReader> keys;
  if (wanted.has_keys)
    keys.emplace(*poller, [&](char key, MonoTime now) { on_key(*program, key, now); });
  const bool has_meters = isatty(STDERR_FILENO) == 1 && keys && keys->is_there();
  if (has_meters)
    poller->add_timer(mono_now(), [&](MonoTime now) {
      line.show(program->meters(now));
      return now + Duration::ms(100);
    });
  if (options.seconds > 0.0)
    poller->add_timer(mono_now() + Duration::seconds(options.seconds), [&](MonoTime) {
      poller->stop();
      return MonoTime();
    });
  poller->run();
  if (has_meters) std::fputs("\n", stderr);
  poller->unwatch(bus->fd());
  if (options.json) std::printf("%s\n", program->report_json().c_str());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::VoiceOptions options;
  dance::CommandLine line("Speak with the others, and hear them where their dancers stand.",
                          "dance voice");
  line.add("--guest", options.guest, "who speaks, and whose dancer hears").guest_name().required();
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add("--microphone", options.microphone, "which one; `pactl list short sources` names them");
  line.add("--loudspeaker", options.loudspeaker, "which one; `pactl list short sinks` names them");
  line.add("--reference", options.reference,
           "the sink whose sound is taken out of the microphone's, as that of the room's music, "
           "instead of the loudspeaker's");
  line.add_flag("--to-headphones", options.to_headphones,
                "the microphone does not hear what is played: no echo cancellation, unless "
                "--reference names what it hears");
  line.add_flag("--no-echo-cancellation", options.no_echo_cancellation,
                "another program takes the echo out, or nobody minds");
  line.add_flag("--no-cleaning", options.no_cleaning, "noise stays, loudness is as it is");
  line.add_flag("--push-to-talk", options.push_to_talk,
                "heard only while the space bar is held, or B in dance view");
  line.add_flag("--mute", options.mute, "not heard until told otherwise");
  line.add_flag("--deafen", options.deafen, "neither hears nor is heard until told otherwise");
  line.add("--volume", options.volumes, "GUEST=0 to GUEST=2, as bob=0.5; may be repeated")
      .one_each_time();
  line.add_flag("--with-picture", options.with_picture,
                "a voice as late as its dancer is shown, as counting aloud to the music needs");
  line.add_flag("--at-once", options.at_once, "as early as the line lets it, as talking needs");
  line.add("--buffer", options.buffer_ms,
           "milliseconds of sound before the loudspeaker; it grows where the machine is too busy")
      .range(5.0, 200.0)
      .shows_default();
  line.add("--bitrate", options.bitrate_kbit, "of the own voice, in kbit/s")
      .range(6.0, 96.0)
      .shows_default();
  line.add_flag("--low-delay", options.low_delay,
                "4 ms earlier, without copies against loss: for good lines");
  line.add_flag("--quiet", options.quiet, "no level meters, and no keys");
  line.add_flag("--json", options.json, "write what was counted to stdout at the end");
  line.add("--seconds", options.seconds, "end after so long; 0 = Ctrl-C").range(0.0, 1e7);
  line.footer(dance::kExamples);
  line.finally([&]() -> dance::Result<void> {
    if (options.with_picture && options.at_once)
      return dance::fail("--with-picture and --at-once exclude each other");
    for (const std::string& volume : options.volumes)
      if (auto set = options.settings.set_volume(volume); !set)
        return dance::fail("--volume: " + set.error().what);
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run_voice(options); });
}
