// dance-bench-tunnel: a crowd through the tunnel's server, beside bare UDP and ENet relays,
// measured in one run.

#include <cstdio>

#include "bench/tunnel/bench_tunnel.h"
#include "bench/tunnel/crowd.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench tunnel                       30 guests at 60 Hz, 10 s of each relay, as a table
  dance bench tunnel --guests 2 --json     a couple, who never wait for each other
  dance bench tunnel --share-ms 0          a crowd without the server's window
  dance bench tunnel --guests 8 --voice 8  poses beside eight who talk, and without them
  dance bench tunnel --codec plain         what the way takes without the time of a codec
All guests live in one process and each relay in one of its own, over this machine's loopback.
)";

struct Options {
  BenchTunnelOptions bench;
  std::string codec = "lattice";
  bool is_json = false;
  // Only given by this program to itself.
  std::string relay;
  std::uint16_t port = 0;
};

Result<void> run(const Options& options) {
  if (options.relay == "udp") return tl::make_unexpected(relay_udp(options.port));
#if DANCE_HAVE_ENET
  if (options.relay == "enet") return tl::make_unexpected(relay_enet(options.port));
#else
  talk::info("built without ENet (libenet-dev): its relay is left out");
#endif
  BenchTunnelOptions bench = options.bench;
  bench.is_plain = options.codec == "plain";
  if (bench.voices > bench.guests)
    return fail("--voice: of " + std::to_string(bench.guests) +
                " guests no more can talk; --guests makes more");
  DANCE_TRY(const TunnelWays ways,
            run_bench_tunnel(bench, program_folder() + "/dance-bench-tunnel"));
  const std::string text =
      options.is_json ? bench_tunnel_json(bench, ways) : bench_tunnel_table(bench, ways);
  std::fputs(text.c_str(), stdout);
  if (ways[0].together.delivered == 0 || ways[0].spread.delivered == 0)
    return fail("nothing was delivered while it was measured");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("A crowd through the tunnel's server, beside bare UDP and ENet relays.",
                          "dance bench tunnel");
  line.add("--guests", options.bench.guests, "dancers, each with a link of her own")
      .range(2, 30)
      .shows_default();
  line.add("--hz", options.bench.hz, "poses a second").range(1.0, 240.0).shows_default();
  line.add("--seconds", options.bench.seconds, "how long to measure each relay")
      .range(0.5, 3600.0)
      .shows_default();
  line.add("--share-ms", options.bench.share_ms,
           "how long the server lets poses wait to share a datagram; else as it chooses")
      .range(0.0, 20.0);
  line.add("--voice", options.bench.voices,
           "so many guests talk: poses with that beside poses without, instead of other relays")
      .range(0, 8);
  line.add("--codec", options.codec, "of the tunnel's poses")
      .one_of({"lattice", "plain"})
      .shows_default();
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.add("--relay", options.relay, "").one_of({"udp", "enet"}).hidden();
  line.add("--port", options.port, "").hidden();
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
