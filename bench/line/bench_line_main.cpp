// dance-bench-line: two dancers over recorded lines, with the real server and links, measured.

#include <cstdio>

#include "bench/line/bench_line.h"
#include "core/program/program.h"
#include "testing/line/line_options.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench line                                    over a clean line
  dance bench line wifi.csv.xz lte.up.xz,lte.down.xz  over recorded ones too, all at the same time
  dance bench line lte.csv.xz --offset 0 --offset 61  from two of its moments on
  dance bench line wifi.csv.xz --link delay=20ms      recorded beyond a floor of 20 ms
  dance bench line --link 'delay=40ms loss=2% burst=3' --seconds 10 --markdown
A house at the server and one behind the line, a dancer in each: up is the way of the one behind it.
Exits with 1 where a pose came after a newer one, or the houses do not know each other at the end.
)";

struct Options {
  BenchLineOptions bench;
  bool is_json = false, is_markdown = false;
};

Result<void> run(const Options& options) {
  DANCE_TRY(const BenchLineResult result, run_bench_line(options.bench));
  const std::string text = options.is_json       ? bench_line_json(options.bench, result)
                           : options.is_markdown ? bench_line_markdown(options.bench, result)
                                                 : bench_line_table(options.bench, result);
  std::fputs(text.c_str(), stdout);
  return check_lines(result);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("Two dancers over recorded lines: what comes, how old, and what shows.",
                          "dance bench line");
  line.add("trace", options.bench.files,
           "recorded lines as dance lossy takes them; UP,DOWN where each way has its own");
  dance::add_link_options(line, options.bench.link);
  line.add("--offset", options.bench.offsets_s,
           "seconds into the traces at which they begin; of several, each trace from each");
  line.add("--seconds", options.bench.seconds, "of dancing").range(0.5, 3600.0).shows_default();
  line.add("--hz", options.bench.hz, "poses a second").range(1.0, 240.0).shows_default();
  line.add("--at-once", options.bench.at_once, "lines at a time").range(1, 64).shows_default();
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.add_flag("--markdown", options.is_markdown, "the table as Markdown");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
