// BenchFlood: a couple dances through a server while a flood of hostile datagrams comes at it, from
// one address and from many: what the couple notices, what the server's memory does, and what it
// counts.
//
// Units/frames: microseconds from a guest's link to the other's; kilobytes of resident memory.
// Ownership:    owns the server's process, which ends with it.
// Threads:      the flood has one of its own; all else runs in the caller's.
// Failure:      run_bench_flood() names what could not start; a server that ended is part of the
//               result.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bench/tunnel/flood_attack.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct BenchFloodOptions {
  std::uint64_t datagrams = 1'000'000;
  double per_second = 50'000.0;
  std::size_t sources = 64;
  double hz = 60.0;
  double calm_s = 5.0;
};

struct FloodPhase {
  std::string name;  // as in the JSON: before, flood, after
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  std::vector<Duration> took;  // sorted
  double seconds = 0.0;
  double server_cpu_percent = 0.0;
  std::int64_t server_rss_kb = 0;  // at its end
};

struct FloodResult {
  std::vector<FloodPhase> phases;
  FloodAttack::Totals attack;
  bool has_server_ended = false;
  std::vector<std::pair<std::string, std::uint64_t>> kept_out;  // the server's counters, by cause
  std::uint64_t poses_shown_old = 0;                            // after a newer one
};

Result<FloodResult> run_bench_flood(const BenchFloodOptions& options);

std::string bench_flood_table(const BenchFloodOptions& options, const FloodResult& result);
std::string bench_flood_json(const BenchFloodOptions& options, const FloodResult& result);

}  // namespace dance
