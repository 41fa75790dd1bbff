// dance-bench-headset: from a headset's sensors to the link, with the real programs.

#include <cstdio>

#include "bench/headset/bench_headset.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench headset                       90 Hz for 10 s, as a table
  dance bench headset --hz 200 --seconds 5
No headset is needed: a test runtime stands behind OpenXR's own loader.
)";

Result<void> run(const BenchHeadsetOptions& options) {
  DANCE_TRY(const BenchHeadsetResult result, run_bench_headset(options));
  std::fputs(bench_headset_table(options, result).c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::BenchHeadsetOptions options;
  bool by_rules = false;
  dance::CommandLine line("From a headset's sensors to the link, with the real programs.",
                          "dance bench headset");
  line.add("--hz", options.hz, "poses a second").range(20.0, 500.0).shows_default();
  line.add("--seconds", options.seconds, "how long to measure").range(0.5, 3600.0).shows_default();
  line.add_flag("--rules", by_rules, "the body by rules alone, without the network");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] {
    options.learned = !by_rules;
    return dance::run(options);
  });
}
