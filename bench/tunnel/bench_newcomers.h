// Bench of newcomers: how long a guest needs from opening a link until it is in the room. Measured
// in calm, during a flood of handshakes that are never finished, and while all guests of a server
// return after its restart under that flood.
//
// Each newcomer and each guest has an IPv4 network of its own. Needs a private network
// (enter_private_network()), in which it adds local routes.
//
// Failure: run_bench_newcomers() names what could not start; guests who did not get in are counted.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "testing/flood/newcomer_flood.h"

namespace dance {

struct BenchNewcomersOptions {
  std::size_t newcomers = 40;  // in each phase, one after the other
  std::size_t guests = 300;    // who return after the restart
  double hellos_per_second = 3000.0;
  int network_bits = 16;  // the flood comes from 2 to the power of this IPv6 /64s
};

struct NewcomerTimes {
  std::string name;            // as in the JSON: calm, flood, restart, returning
  std::vector<Duration> took;  // sorted
  std::size_t missing = 0;     // not in the room after 30 s
};

struct NewcomersResult {
  std::vector<NewcomerTimes> phases;
  NewcomerFlood::Totals attack;
  double server_cpu_percent = 0.0;  // during the flood, before the restart
};

Result<NewcomersResult> run_bench_newcomers(const BenchNewcomersOptions& options);

std::string bench_newcomers_table(const BenchNewcomersOptions& options,
                                  const NewcomersResult& result);
std::string bench_newcomers_json(const BenchNewcomersOptions& options,
                                 const NewcomersResult& result);

}  // namespace dance
