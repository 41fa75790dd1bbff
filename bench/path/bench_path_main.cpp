// dance-bench-path: a pose's journey from house to house against the same number of bare hops,
// measured in one run.

#include <array>
#include <cstdio>

#include "bench/path/bare_hops.h"
#include "bench/path/bench_path.h"
#include "bench/path/bus_flood.h"
#include "bench/path/measured_way.h"
#include "core/bus/bus.h"
#include "core/bus/bus_url.h"
#include "core/bus/route/multicast_route.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "testing/private_network.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench path                         60 Hz for 10 s, as a table
  dance bench path --hz 60 --seconds 10 --json
  dance bench path --flood 10000 --seconds 60
                                           beside 10,000 hostile datagrams a second on both buses,
                                           in every second stretch of 5 s
A floor goes through three processes that only forward bytes, over two buses and two UDP hops: with
LCM's library as the bus, and with bare multicast sockets. LCM needs a multicast route: without one
over lo all runs in a private network.
)";

struct Options {
  BenchPathOptions bench;
  bool is_json = false;
  // Only given by this program to itself.
  std::string bare_hop;
  std::string url;
  std::uint16_t group_port = 0;
  std::uint16_t from_port = 0;
  std::uint16_t to_port = 0;
};

Error run_bare_hop(const Options& o) {
  constexpr const char* kChannel = LcmEnd::kChannel;
  if (o.bare_hop == "bus-to-udp") return forward_bus_to_udp(o.url, kChannel, o.to_port);
  if (o.bare_hop == "udp-to-udp") return forward_udp_to_udp(o.from_port, o.to_port);
  if (o.bare_hop == "group-to-udp") return forward_group_to_udp(o.group_port, o.to_port);
  if (o.bare_hop == "udp-to-group") return forward_udp_to_group(o.from_port, o.group_port);
  if (o.bare_hop == "flood")
    return flood_buses(std::array{o.from_port, o.to_port}, o.bench.flood_hz);
  return forward_udp_to_bus(o.from_port, o.url, kChannel);
}

Result<void> run(const Options& options) {
  if (!options.bare_hop.empty()) return tl::make_unexpected(run_bare_hop(options));
  DANCE_TRY(const BusAddress bus, parse_udpm_url(kDefaultBusUrl));
  if (multicast_device(bus.group) != "lo") {
    if (auto entered = enter_private_network(); !entered)
      return fail(entered.error().what + "; or give lo a multicast route: " + kMulticastCure);
    talk::info("lo has no multicast route here: measuring in a private network");
  }
  DANCE_TRY(const BenchPathResult result,
            run_bench_path(options.bench, program_folder() + "/dance-bench-path"));
  const std::string text = options.is_json ? bench_path_json(options.bench, result)
                                           : bench_path_table(options.bench, result);
  std::fputs(text.c_str(), stdout);
  if (result.pose.took.empty() || result.floor.took.empty() || result.raw_floor.took.empty())
    return fail("nothing was delivered while it was measured");
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Options options;
  dance::CommandLine line("A pose's journey against the same number of bare hops, in one run.",
                          "dance bench path");
  line.add("--hz", options.bench.hz, "poses a second").range(1.0, 1000.0).shows_default();
  line.add("--seconds", options.bench.seconds, "how long to measure")
      .range(0.1, 3600.0)
      .shows_default();
  line.add("--flood", options.bench.flood_hz,
           "hostile datagrams a second on both buses, for half of the time")
      .range(0.0, 1e6);
  line.add_flag("--json", options.is_json, "one JSON object instead of the table");
  line.add("--bare-hop", options.bare_hop, "")
      .one_of({"bus-to-udp", "udp-to-udp", "udp-to-bus", "group-to-udp", "udp-to-group", "flood"})
      .hidden();
  line.add("--url", options.url, "").hidden();
  line.add("--group-port", options.group_port, "").hidden();
  line.add("--from-port", options.from_port, "").hidden();
  line.add("--to-port", options.to_port, "").hidden();
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(options); });
}
