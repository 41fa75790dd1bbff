// dance-bench-flood: a couple dances through a server that is flooded.

#include <cstdio>

#include "bench/tunnel/bench_flood.h"
#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench flood                                    a million hostile datagrams, as a table
  dance bench flood --datagrams 10000000 --rate 100000 ten million
  dance bench flood --sources 1 --json                 all of it from one address
Everything stays on this machine's loopback addresses.
)";

Result<void> run_flood(const BenchFloodOptions& options, bool is_json) {
  DANCE_TRY(const FloodResult result, run_bench_flood(options));
  const std::string text =
      is_json ? bench_flood_json(options, result) : bench_flood_table(options, result);
  std::fputs(text.c_str(), stdout);
  if (result.has_server_ended) return fail("the server ended under the flood");
  if (result.attack.let_in > 0) return fail("a wrong key was let in");
  if (result.attack.bytes_answered > result.attack.bytes_sent)
    return fail("the server answered more than it was sent");
  if (result.poses_shown_old > 0) return fail("a pose came after a newer one");
  if (result.phases.back().delivered == 0) return fail("the couple does not dance any more");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::BenchFloodOptions options;
  bool is_json = false;
  dance::CommandLine line("A couple dances through a server that is flooded.", "dance bench flood");
  line.add("--datagrams", options.datagrams, "hostile datagrams in all")
      .range(1, 1e9)
      .shows_default();
  line.add("--rate", options.per_second, "of them a second").range(1.0, 1e6).shows_default();
  line.add("--sources", options.sources, "addresses that they come from; half come from the first")
      .range(1, 10'000)
      .shows_default();
  line.add("--hz", options.hz, "poses a second of each of the couple")
      .range(1.0, 240.0)
      .shows_default();
  line.add("--calm", options.calm_s, "seconds of dancing before and after")
      .range(0.5, 600.0)
      .shows_default();
  line.add_flag("--json", is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_flood(options, is_json); });
}
