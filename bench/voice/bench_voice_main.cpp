// dance bench voice: what voices cost, bear and take.

#include <cstdio>

#include "bench/voice/bench_voice.h"
#include "core/program/program.h"
#include "testing/private_network.h"
#include "testing/scratch_folder.h"
#include "testing/voice/speech.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench voice                                 codec, described lines and echo
  dance bench voice --only lines wifi.csv.xz        over a recorded line
  dance bench voice --only ear                      from one mouth to another's ear, with real
                                                    programs and a sound server of its own
  dance bench voice --only room                     what comes back from a loudspeaker, with those
)";

constexpr std::size_t kEarSpeech = 48'000 * 15;

struct BenchVoiceOptions {
  std::vector<std::string> traces;
  std::vector<std::string> links{"delay=20ms", "delay=40ms jitter=20ms loss=2% burst=2",
                                 "delay=60ms tail=15ms loss=5%"};
  std::string speech;
  std::string only;
  double seconds = 60.0;
  bool is_json = false;
};

Result<void> bench_voice(const BenchVoiceOptions& options) {
  DANCE_TRY(const auto scratch, ScratchFolder::make());
  Speech near, far;
  if (options.speech.empty()) {
    DANCE_TRY(near, make_speech(options.seconds, 0, scratch->file("near.wav")));
    DANCE_TRY(far, make_speech(options.seconds, 1, scratch->file("far.wav")));
  } else {
    DANCE_TRY(near, read_speech(options.speech));
    far = Speech(near.rbegin(), near.rend());
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  const auto run = [&](const char* part, auto make) -> Result<void> {
    if (!options.only.empty() && options.only != part) return {};
    DANCE_TRY(const BenchReport report, make());
    all[part] = report.json;
    if (!options.is_json) std::printf("%s\n", report.text.c_str());
    std::fflush(stdout);
    return {};
  };
  auto done = run("codec", [&] { return bench_voice_codec(near); });
  if (done)
    done = run("lines", [&] { return bench_voice_lines(near, options.traces, options.links); });
  if (done && (options.only == "ear" || options.only == "room")) done = enter_private_network();
  if (done) done = run("echo", [&] { return bench_voice_echo(near, far); });
  // These take programs, a minute, and a machine that is not busy: only when they are asked for.
  const auto few = Speech(
      near.begin(), near.begin() + static_cast<std::ptrdiff_t>(std::min(near.size(), kEarSpeech)));
  if (done && options.only == "ear")
    done = run("ear", [&] { return bench_voice_ear(few, scratch->file("")); });
  if (done && options.only == "room")
    done = run("room", [&] { return bench_voice_room(few, scratch->file("")); });
  if (!done) return done;
  if (options.is_json) std::printf("%s\n", all.dump(2).c_str());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::BenchVoiceOptions options;
  dance::CommandLine line("What voices cost, bear and take, each beside a baseline.",
                          "dance bench voice");
  line.add("TRACE", options.traces, "recorded lines, as dance lossy takes them");
  line.add("--link", options.links, "described lines, as dance lossy takes them").one_each_time();
  line.add("--speech", options.speech, "a file of speech instead of espeak-ng's");
  line.add("--only", options.only, "one part: codec, lines, echo, ear, room")
      .one_of({"codec", "lines", "echo", "ear", "room"});
  line.add("--seconds", options.seconds, "of speech").range(10.0, 600.0);
  line.add_flag("--json", options.is_json, "figures as JSON");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::bench_voice(options); });
}
