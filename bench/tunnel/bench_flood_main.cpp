// dance-bench-flood: the cost of a flood for a couple that dances, and for newcomers.

#include <cstdio>

#include "bench/tunnel/bench_flood.h"
#include "bench/tunnel/bench_newcomers.h"
#include "core/program/program.h"
#include "testing/private_network.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench flood                                    a million hostile datagrams, as a table
  dance bench flood --datagrams 10000000 --rate 100000 ten million
  dance bench flood --sources 1 --json                 all of it from one address
  dance bench flood --only newcomers                   the time until a newcomer is in the room
  dance bench flood --only newcomers --network-bits 8  the same, flooded from one IPv6 /56
Everything stays in a network namespace of its own. With --json each part is one line.
)";

enum class Part : std::uint8_t { kAll, kCouple, kNewcomers };

struct Options {
  BenchFloodOptions couple;
  BenchNewcomersOptions newcomers;
  Part part = Part::kAll;
  bool is_json = false;
};

Result<void> run_couple(const BenchFloodOptions& options, bool is_json) {
  DANCE_TRY(const FloodResult result, run_bench_flood(options));
  const std::string text =
      is_json ? bench_flood_json(options, result) : bench_flood_table(options, result);
  std::fputs(text.c_str(), stdout);
  if (result.has_server_ended) return fail("the server ended during the flood");
  if (result.attack.let_in > 0) return fail("a wrong key was let in");
  if (result.attack.bytes_answered > result.attack.bytes_sent)
    return fail("the server answered with more bytes than it received");
  if (result.poses_shown_old > 0) return fail("a pose was delivered after a newer one");
  if (result.phases.back().delivered == 0) return fail("no pose was delivered after the flood");
  return {};
}

Result<void> run_newcomers(const BenchNewcomersOptions& options, bool is_json) {
  DANCE_TRY(const NewcomersResult result, run_bench_newcomers(options));
  const std::string text =
      is_json ? bench_newcomers_json(options, result) : bench_newcomers_table(options, result);
  std::fputs(text.c_str(), stdout);
  for (const NewcomerTimes& phase : result.phases)
    if (phase.missing > 0)
      return fail(std::to_string(phase.missing) + " did not come in within 30 s: " + phase.name);
  return {};
}

Result<void> run_flood(const Options& options) {
  if (auto entered = enter_private_network(); !entered) return entered;
  if (options.part != Part::kNewcomers)
    if (auto done = run_couple(options.couple, options.is_json); !done) return done;
  if (options.part == Part::kAll && !options.is_json) std::fputs("\n", stdout);
  if (options.part == Part::kCouple) return {};
  return run_newcomers(options.newcomers, options.is_json);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line(
      "Measures what a flood of hostile datagrams costs a dancing couple, and newcomers.",
      "dance bench flood");
  line.add_choice<dance::Part>(
      "--only", options.part,
      {{"couple", dance::Part::kCouple}, {"newcomers", dance::Part::kNewcomers}},
      "one of the two parts");
  line.add("--datagrams", options.couple.datagrams, "hostile datagrams in all")
      .range(1, 1e9)
      .shows_default();
  line.add("--rate", options.couple.per_second, "hostile datagrams a second")
      .range(1.0, 1e6)
      .shows_default();
  line.add("--sources", options.couple.sources,
           "addresses that they come from; half come from the first")
      .range(1, 10'000)
      .shows_default();
  line.add("--hz", options.couple.hz, "poses a second of each of the couple")
      .range(1.0, 240.0)
      .shows_default();
  line.add("--calm", options.couple.calm_s, "seconds of dancing before and after")
      .range(0.5, 600.0)
      .shows_default();
  line.add("--newcomers", options.newcomers.newcomers, "newcomers in each phase, one by one")
      .range(1, 10'000)
      .shows_default();
  line.add("--guests", options.newcomers.guests, "guests that return after a restart of the server")
      .range(0, 1000)
      .shows_default();
  line.add("--hellos", options.newcomers.hellos_per_second,
           "handshakes a second that an attacker begins and does not finish")
      .range(1.0, 100'000.0)
      .shows_default();
  line.add("--network-bits", options.newcomers.network_bits,
           "the attacker's IPv6 network has 2 to the power of this /64s: 8 = a /56, 16 = a /48")
      .range(0, 16)
      .shows_default();
  line.add_flag("--json", options.is_json, "JSON instead of tables, one line for each part");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_flood(options); });
}
