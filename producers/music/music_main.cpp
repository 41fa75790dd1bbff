// dance music: plays a music file, publishes its beats as they are heard in this house, and plays
// in step with the room.

#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "producers/music/control/music_control.h"
#include "producers/music/file/file_deck.h"
#include "producers/music/file/slowed_source.h"
#include "producers/music/file_source.h"
#include "producers/music/music_program.h"
#include "producers/music/room/band_program.h"
#include "producers/music/room/band_source.h"
#include "producers/music/sound/microphone_beats.h"
#include "producers/music/sound/pulse_player.h"
#include "producers/music/tap/tap_program.h"
#include "producers/music/tracker/tempo/steps_hint.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance music song.ogg                       plays it, with the beats of song.beats beside it
  dance music song.ogg --beats list.beats    with others
  dance music song.ogg --guest alice         for the room: followers hear the same position in it
  dance music song.ogg --guest bob --follow  joins the room's song where it stands; begins it where
                                             the room has no music
  dance music --follow                       keeps the room's time, without the song
  dance music song.ogg --silent              keeps the time only, on a machine without sound
  dance music song.ogg --trim 120ms          through a loudspeaker that is late by so much
  dance music --tap                          finds that time: press Enter with each click
  dance music --band salsa                   the house band plays, one song after the other
  dance music --band tango --guest bob --follow
                                             the same band in all houses of the room
  dance music --microphone                   plays nothing: publishes the beat that it records
  dance music --microphone --steps 96        where it could be heard as 192
A song without a list of beats is analysed before it starts, within a few per cent of its length.
A .beats file is text: seconds, TAB, position in the bar.
)";

constexpr Duration kMicrophoneTurn = Duration::ms(10);

struct ProgramOptions {
  std::string file;
  std::string beats;
  std::string bus;
  std::string guest;
  std::string start;
  std::string trim = "0ms";
  bool follow = false;
  bool silent = false;
  bool loop = false;
  bool alone = false;
  bool tap = false;
  bool microphone = false;
  std::string source;
  std::string band;
  int tempo_bpm = 0;
  std::int64_t seed = -1;
  double steps_bpm = 0.0;
  double volume = 1.0;
  double seconds = 0.0;
};

// "20ms", "-5ms", "1.5s", "800us".
std::optional<Duration> duration_of(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  const double scale = unit == "s" ? 1.0 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 0.0;
  if (scale == 0.0 || !(value * scale > -1e9 && value * scale < 1e9)) return std::nullopt;
  return Duration::seconds(value * scale);
}

Result<MonoTime> start_of(const ProgramOptions& options, MonoTime now) {
  // Time to start the sound, and for the room's houses to learn of the song.
  if (options.start.empty())
    return now + (options.guest.empty() || options.alone ? Duration::ms(500) : Duration::s(2));
  if (options.start[0] == '+') {
    if (const auto later = duration_of(std::string_view(options.start).substr(1)))
      return now + *later;
  } else {
    std::int64_t us = 0;
    const char* end = options.start.data() + options.start.size();
    const auto read = std::from_chars(options.start.data(), end, us);
    if (read.ec == std::errc() && read.ptr == end && us > 0) return MonoTime::from_us(us);
  }
  return fail("--start '" + options.start +
              "': give microseconds of this machine's monotonic clock, as --start-us of other "
              "producers, or a time from now like +2s");
}

// Who says it means it.
Result<void> check_hint(const ProgramOptions& options) {
  if (options.steps_bpm > 0.0 && options.steps_bpm < kLeastTempo_bpm)
    return fail("--steps takes 20 to 400 steps a minute, or 0 for what is heard");
  return {};
}

TempoHint hint_of(const ProgramOptions& options) { return {options.steps_bpm, 1.0}; }

Result<Duration> trim_of(const ProgramOptions& options) {
  const auto trim = duration_of(options.trim);
  if (!trim || *trim > Duration::s(5) || *trim < -Duration::s(5))
    return fail("--trim '" + options.trim + "': give a time like 20ms");
  return *trim;
}

std::unique_ptr<MusicPlayer> player_or_silence(std::unique_ptr<MusicSource> source,
                                               const ProgramOptions& options, Duration trim) {
  auto player = PulsePlayer::open(std::move(source), {options.volume, trim});
  if (player) return std::move(*player);
  talk::warn("{}; keeps the time without sound", player.error().what);
  return std::make_unique<SilentPlayer>();
}

void stop_after(Poller& poller, double seconds) {
  if (seconds > 0.0)
    poller.add_timer(mono_now() + Duration::seconds(seconds), [&poller](MonoTime) {
      poller.stop();
      return MonoTime();
    });
}

// Plays nothing: tracks the beat of the recorded sound.
Result<void> follow_microphone(const ProgramOptions& options) {
  if (auto hint = check_hint(options); !hint) return hint;
  DANCE_TRY(const Duration trim, trim_of(options));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto microphone, MicrophoneBeats::open(options.source, trim));
  // Where the music can be danced at two levels, those who dance here decide.
  StepsHint hint(hint_of(options));
  DANCE_TRY(auto bus, Bus::open(options.bus));
  BeatPublisher publisher(*bus, *poller, [&](MonoTime now) { return microphone->beat(now); });
  bus->subscribe<Steps>(Where::kLocal, [&hint](const Channel&, const Steps& steps, MonoTime now) {
    if (steps.clock_id == this_clock_id()) hint.hear(steps, now);
  });
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  Result<void> worked;
  poller->add_timer(mono_now(), [&](MonoTime now) {
    microphone->set_tempo_hint(hint.at(now));
    worked = microphone->work(now);
    if (!worked) poller->stop();
    return now + kMicrophoneTurn;
  });
  bool warned_of_another = false;
  poller->add_timer(mono_now(), [&](MonoTime now) {
    if (publisher.has_other_publisher(now) && !warned_of_another)
      talk::warn("{}", kAnotherPublisher);
    warned_of_another = publisher.has_other_publisher(now);
    return now + Duration::s(1);
  });
  stop_after(*poller, options.seconds);
  talk::info("listens; Ctrl-C ends it");
  poller->run();
  poller->unwatch(bus->fd());
  talk::info("{} beats published", publisher.published());
  return worked;
}

// Where there is something to be heard; without it, it plays all the same.
std::unique_ptr<MusicControl> control_of(const ProgramOptions& options, FileDeck& deck,
                                         Poller& poller) {
  if (options.silent || options.file.empty()) return nullptr;
  auto control = MusicControl::open(
      options.bus, [&deck](const MusicCommand& command) { deck.apply(command); }, poller);
  if (control) return std::move(*control);
  talk::warn("{}", control.error().what);
  return nullptr;
}

Result<FileDeck::Options> deck_options(const ProgramOptions& options) {
  DANCE_TRY(const Duration trim, trim_of(options));
  FileDeck::Options deck;
  deck.file = {options.file, options.beats};
  deck.hint = hint_of(options);
  deck.is_alone = options.alone;
  deck.begin = [&options](MonoTime now) { return start_of(options, now); };
  deck.make_player = [&options, trim](AudioFile audio) -> std::unique_ptr<MusicPlayer> {
    if (options.silent) return std::make_unique<SilentPlayer>();
    std::unique_ptr<MusicSource> source = std::make_unique<FileSource>(std::move(audio));
    if (options.alone) source = std::make_unique<SlowedSource>(std::move(source));
    return player_or_silence(std::move(source), options, trim);
  };
  return deck;
}

Result<BandRoom::Options> band_options(const ProgramOptions& options) {
  BandRoom::Options band;
  const auto style = band_style_of(options.band);
  if (!style) return fail("--band '" + options.band + "': the band plays " + band_style_names());
  band.style = *style;
  band.tempo_bpm = options.tempo_bpm;
  band.follows = options.follow;
  band.clock_id = this_clock_id();
  band.seed = static_cast<std::uint32_t>(
      options.seed >= 0 ? static_cast<std::uint64_t>(options.seed) : secure_random_u64());
  if (!options.guest.empty()) band.guest = *GuestId::parse(options.guest);
  const int bpm = options.tempo_bpm > 0 ? options.tempo_bpm : usual_tempo_bpm(*style);
  if (!is_valid(band_song(*style, band.seed, bpm)))
    return fail("--tempo " + std::to_string(bpm) + ": the band plays " + options.band +
                " at about " + std::to_string(usual_tempo_bpm(*style)) + " beats a minute");
  return band;
}

Result<void> play_band(const ProgramOptions& options) {
  DANCE_TRY(const BandRoom::Options band, band_options(options));
  DANCE_TRY(const Duration trim, trim_of(options));
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto bus, Bus::open(options.bus));
  HousePublisher port(*bus, bus->url(), *poller);
  BandProgram program(band, options.volume, port, *poller);
  if (!options.silent) {
    DANCE_TRY(auto source, BandSource::make(program.set(), best_band_sound()));
    talk::info("the house band: {}", source->sound());
    program.set_player(player_or_silence(std::move(source), options, trim));
  }
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  const auto control = MusicControl::open(
      options.bus, [&program](const MusicCommand& command) { program.apply(command); }, *poller);
  if (!control) talk::warn("{}", control.error().what);
  stop_after(*poller, options.seconds);
  poller->run();
  program.stop(mono_now());
  poller->unwatch(bus->fd());
  talk::info("{} beats published; {}", program.publisher().published(), program.summary());
  return {};
}

// Prints what is to be put into the house file.
Result<void> tap_along(const ProgramOptions& options) {
  DANCE_TRY(auto poller, Poller::create());
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto player,
            PulsePlayer::open(std::make_unique<ClickSource>(), {options.volume, Duration()}));
  talk::info("press Enter with each click that you hear, {} times",
             TapDelay::kFirst + TapDelay::kTaps);
  DANCE_TRY(const TapDelay::Result found, run_taps(*player, STDIN_FILENO, *poller));
  const long trim_ms = std::lround(1e3 * found.delay_s);
  std::printf("trim_ms = %ld\n", trim_ms);
  talk::info("put this line into [music] of the house file, or start with --trim {}ms", trim_ms);
  return {};
}

Result<void> play(const ProgramOptions& options) {
  if (options.tap) return tap_along(options);
  if (auto hint = check_hint(options); !hint) return hint;
  if (!options.band.empty()) return play_band(options);
  if (options.microphone) return follow_microphone(options);
  if (options.file.empty() && !options.follow)
    return fail(
        "nothing to play: name a file, let the house band play with --band salsa, keep the room's "
        "time with --follow, or listen with --microphone");
  if (options.alone && options.follow)
    return fail("--alone: there is no room to follow; leave --follow out");
  DANCE_TRY(auto poller, Poller::create());
  MusicProgramOptions program_options;
  program_options.loops = options.loop;
  if (!options.guest.empty()) program_options.guest = *GuestId::parse(options.guest);
  program_options.follows = options.follow;
  std::unique_ptr<MusicPlayer> player = std::make_unique<SilentPlayer>();
  DANCE_TRY(FileDeck::Options chosen, deck_options(options));
  FileDeck deck(std::move(chosen), *poller);
  if (!options.file.empty()) {
    DANCE_TRY(player, deck.open(program_options));
  }
  if (auto stops = poller->stop_on_signals(); !stops) return stops;
  DANCE_TRY(auto bus, Bus::open(options.bus));
  DANCE_TRY(program_options.begin, start_of(options, mono_now()));
  HousePublisher port(*bus, bus->url(), *poller);
  MusicProgram program(std::move(program_options), std::move(player), port, *poller);
  if (!options.file.empty()) deck.run(program);
  poller->watch(bus->fd(), [&](MonoTime now) { bus->drain(now); });
  const auto control = control_of(options, deck, *poller);
  stop_after(*poller, options.seconds);
  talk::info("{}; Ctrl-C ends it", options.follow ? "listens for the room's music" : "playing");
  poller->run();
  program.stop(mono_now());
  poller->unwatch(bus->fd());
  talk::info("{} beats published; {}", program.publisher().published(), program.summary());
  return deck.result();
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ProgramOptions options;
  dance::CommandLine line("Plays music and publishes its beats as they are heard in this house.",
                          "dance music");
  line.add("FILE", options.file, "the music: .ogg, .flac, .wav, .mp3, .opus, .m4a");
  line.add("--beats", options.beats,
           "list of its beats; without it, the .beats file beside FILE, or what is heard");
  line.add("--bus", options.bus, "LCM URL of the house's bus");
  line.add("--guest", options.guest, "play for the room, as this guest of the house").guest_name();
  line.add_flag("--follow", options.follow, "in step with the room's music, where there is some");
  line.add("--start", options.start,
           "when it begins: +2s from now, or microseconds of this machine's monotonic clock");
  line.add_flag("--silent", options.silent, "keep the time only, without sound");
  line.add_flag("--microphone", options.microphone,
                "play nothing, and publish the beat of what the microphone records");
  line.add("--source", options.source, "which microphone; `pactl list short sources` names them");
  line.add("--band", options.band, "let the house band play: " + dance::band_style_names());
  line.add("--tempo", options.tempo_bpm, "beats a minute of the band; 0 = as the style is danced")
      .range(0, 400);
  line.add("--seed", options.seed, "of the band's first song; -1 = another one each time")
      .range(-1.0, 4294967295.0);
  line.add("--steps", options.steps_bpm,
           "about how many steps a minute are danced to it, where its beats are heard at half or "
           "double of that; 0 = what is heard")
      .range(0.0, 400.0);
  line.add_flag("--loop", options.loop,
                "loop, while this house leads the room or plays for itself");
  line.add_flag(
      "--alone", options.alone,
      "in no room: it plays while its beats are found, and dance music set may stop, slow "
      "and change it");
  line.add("--volume", options.volume, "0 to 1").range(0.0, 1.0);
  line.add("--trim", options.trim,
           "latency of the loudspeaker that the sound server does not know of, like 20ms");
  line.add_flag("--tap", options.tap,
                "find --trim: plays a click, and you press Enter with each click that you hear");
  line.add("--seconds", options.seconds, "end after so long; 0 = when it is over").range(0.0, 1e7);
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::play(options); });
}
