#include <fmt/format.h>
#include <sys/resource.h>

#include "bench/voice/bench_voice.h"
#include "bench/voice/two_houses.h"
#include "core/net/mono_clock.h"
#include "core/program/figures.h"
#include "testing/voice/sound_match.h"

namespace dance {
namespace {

constexpr Duration kEarAfter = Duration::ms(700);
constexpr Duration kEarMost = Duration::s(60);
constexpr int kEarNice = -15;
constexpr double kEarDemand_ms = 60.0;

Result<BenchReport> measure_ear(VoiceHouses& houses, const char* name, const Speech& speech) {
  SoundRooms& rooms = houses.rooms();
  DANCE_TRY(const std::size_t mouth, rooms.listen("mouth-a"));
  DANCE_TRY(const std::size_t ear, rooms.listen("ear-b"));
  if (auto played = rooms.play("mouth-a", speech); !played)
    return tl::make_unexpected(played.error());
  houses.begin_to_count_cpu();
  const MonoTime begin = mono_now();
  houses.work_for(kEarMost, [&] { return rooms.has_played(); });
  houses.work_for(kEarAfter);
  const Duration over = mono_now() - begin;
  const double cpu_alice = houses.cpu_percent("voice-alice", over);
  const double cpu_bob = houses.cpu_percent("voice-bob", over);
  houses.end();
  const MatchFigures figures = figures_of(
      match_sound(rooms.heard(mouth, begin, over), rooms.heard(ear, begin, over), 0.0, 500.0));
  if (figures.fitting == 0)
    return fail(
        "nothing of what alice says is heard at bob's: " + houses.text_of("voice-alice.talk") +
        houses.text_of("voice-bob.talk") + houses.text_of("voice-bob.out"));
  BenchReport report;
  report.text = fmt::format("{:<24} {:>6.1f} ms {:>6.1f} ms {:>5}/{:<5} {:>7.1f}% {:>7.1f}%\n",
                            name, figures.median_ms, figures.p95_ms, figures.fitting,
                            figures.pieces, cpu_alice, cpu_bob);
  report.json = {{"voice", name},
                 {"mouth_to_ear_p50_ms", rounded(figures.median_ms, 10.0)},
                 {"mouth_to_ear_p95_ms", rounded(figures.p95_ms, 10.0)},
                 {"pieces", figures.pieces},
                 {"fitting", figures.fitting},
                 {"speaker_cpu_percent", rounded(cpu_alice, 10.0)},
                 {"listener_cpu_percent", rounded(cpu_bob, 10.0)}};
  for (const std::string guest : {"alice", "bob"}) {
    const auto said =
        nlohmann::ordered_json::parse(houses.text_of("voice-" + guest + ".out"), nullptr, false);
    if (!said.is_discarded()) report.json[guest] = said;
  }
  return report;
}

}  // namespace

Result<BenchReport> bench_voice_ear(const Speech& speech, const std::string& folder) {
  // Those who speak and hear are to be in time; the programs that are measured inherit it.
  const bool is_favoured = ::setpriority(PRIO_PROCESS, 0, kEarNice) == 0;
  BenchReport report;
  report.text = fmt::format(
      "alice speaks into a microphone, and bob hears her through a server; demanded: {:.0f} ms, "
      "both sound buffers\nincluded. fit: pieces of 400 ms that correlate by 0.5 and more{}\n"
      "{:<24} {:>9} {:>9} {:>11} {:>8} {:>8}\n",
      kEarDemand_ms, is_favoured ? "; all at high priority" : "", "voice", "median", "p95", "fit",
      "speaker", "listener");
  struct EarCase {
    const char* name;
    VoiceHouses::Options options;
  };
  const std::array cases{EarCase{"as by default", {{}, true, false}},
                         EarCase{"without the tunnel", {{}, false, false}},
                         EarCase{"--low-delay", {{"--low-delay"}, true, false}},
                         EarCase{"--buffer 100", {{"--buffer", "100"}, true, false}}};
  for (const auto& [name, options] : cases) {
    VoiceHouses houses(folder);
    if (auto started = houses.start(options); !started) return tl::make_unexpected(started.error());
    DANCE_TRY(const BenchReport one, measure_ear(houses, name, speech));
    report.text += one.text;
    report.json.push_back(one.json);
  }
  return report;
}

}  // namespace dance
