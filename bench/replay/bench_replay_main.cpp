// dance-bench-replay: opening and jumping in a long recorded night.

#include <cstdio>

#include "bench/replay/bench_replay.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench replay                              an hour of 30 guests, made first: takes minutes
  dance bench replay --guests 8 --minutes 5 --json
  dance bench replay --log logs/evening.lcm       one of yours; its index is made anew
The log that it makes lies in TMPDIR and is removed. The operating system has it in memory, as it
was just written.
)";

struct Wishes {
  BenchReplayOptions bench;
  double key_s = LogPacker::kIntraFramePeriod.as_seconds();
  bool no_baseline = false;
  bool is_json = false;
};

Result<void> run(const Wishes& wishes) {
  DANCE_TRY(const BenchReplayResult result, run_bench_replay(wishes.bench));
  const std::string text = wishes.is_json ? bench_replay_json(wishes.bench, result)
                                          : bench_replay_table(wishes.bench, result);
  std::fputs(text.c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::BenchReplayOptions& bench = wishes.bench;
  dance::CommandLine line("Opening and jumping in a long recorded night.", "dance bench replay");
  line.add("--guests", bench.night.guests, "dancers of the night").range(1, 64).shows_default();
  line.add("--minutes", bench.night.minutes, "how long it is").range(0.1, 600.0).shows_default();
  line.add_flag("--arriving", bench.night.has_arriving,
                "each pose also as it came into the house, as in the manager's own house");
  line.add("--intra-frames", wishes.key_s, "seconds between intra frames of a channel")
      .range(0.1, 60.0)
      .shows_default();
  line.add("--log", bench.log, "a log of yours instead, packed or plain");
  line.add("--seeks", bench.seeks, "jumps to measure").range(1, 100000).shows_default();
  line.add("--opens", bench.opens, "times to open it again").range(1, 1000).shows_default();
  line.add_flag("--no-baseline", wishes.no_baseline, "does not read the log from its beginning");
  line.add_flag("--json", wishes.is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  line.finally([&]() -> dance::Result<void> {
    bench.night.intra_frame_period = dance::Duration::seconds(wishes.key_s);
    bench.has_baseline = !wishes.no_baseline;
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
