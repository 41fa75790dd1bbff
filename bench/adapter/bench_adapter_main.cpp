// dance-bench-adapter: what an engine pays to read a stage, and how old the dancers are.

#include <cstdio>

#include "bench/adapter/bench_adapter.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench adapter                         30 dancers at 90 Hz, as a table
  dance bench adapter --guests 30 --hz 90 --seconds 5 --json
A house with [[listen]] to = "engine" runs beside it; engines at 60, 72 and 90 Hz read it through
libdance_adapter.so.
publish_to_read is measured by itself: one thread writes poses, another waits for them, and nothing
else of this runs. house_to_read is the same from the house's stage, while everything runs.
Both …_on_processor leave out what was written while the machine had put the reader aside for more
than 0.2 ms.
blocked counts an engine's reads of all dancers that waited for anything (the kernel's count of
voluntary context switches of the thread) or used a processor for more than 50 ms; gave_up counts
calls that were answered with DANCE_BUSY.
)";

struct Options {
  BenchAdapterOptions bench;
  bool is_json = false;
  std::string dancers;  // only given by this program to itself: the bus
};

Result<void> run(const Options& options) {
  if (!options.dancers.empty())
    return run_dancers(options.dancers, options.bench.guests, options.bench.hz);
  DANCE_TRY(BenchAdapterResult result,
            run_bench_adapter(options.bench, program_folder() + "/dance-bench-adapter"));
  const std::string text = options.is_json ? bench_adapter_json(options.bench, result)
                                           : bench_adapter_table(options.bench, result);
  std::fputs(text.c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("What an engine pays to read a stage, and how old the dancers are.",
                          "dance bench adapter");
  line.add("--guests", options.bench.guests, "dancers").range(1.0, 64.0).shows_default();
  line.add("--hz", options.bench.hz, "poses a second of each").range(1.0, 240.0).shows_default();
  line.add("--seconds", options.bench.seconds, "how long to measure each of its parts")
      .range(0.2, 3600.0)
      .shows_default();
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.add("--dancers", options.dancers, "").hidden();
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
