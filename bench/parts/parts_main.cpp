// dance-bench-parts: what each part of the pose path costs, each against its baseline in the same
// run.

#include <cstdio>
#include <iostream>
#include <sstream>

#include "bench/parts/ratio_reporter.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench parts                     everything, about half a minute
  dance bench parts --only codec        one of avatar, body, bus, camera, codec, files,
                                        instruments, osc, predict, stage, style
  DANCE_AVATARS=data/avatars dance bench parts --only avatar
  dance bench parts --json
)";

Result<void> run_parts(const std::string& only, bool is_json) {
  std::vector<std::string> words{"dance-bench-parts", "--benchmark_repetitions=5",
                                 "--benchmark_report_aggregates_only=true",
                                 "--benchmark_min_time=0.1", "--benchmark_filter=^" + only};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  RatioReporter reporter;
  std::ostringstream unseen;
  reporter.SetOutputStream(is_json ? &unseen : &std::cout);
  reporter.SetErrorStream(&std::cerr);
  benchmark::RunSpecifiedBenchmarks(&reporter);
  if (is_json) std::puts(reporter.json().c_str());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::string only;
  bool json = false;
  dance::CommandLine line(
      "What each part of the pose path costs, against a baseline in the same run.",
      "dance bench parts");
  line.add("--only", only, "one part")
      .one_of({"avatar", "body", "bus", "camera", "codec", "files", "instruments", "osc", "predict",
               "stage", "style"});
  line.add_flag("--json", json, "as JSON");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_parts(only, json); });
}
