// BenchPath: how long a pose takes from one house's bus to the stage of the other, and, in the same
// run and turn about, how long the same number of bare hops takes: with LCM's library as the bus,
// and with bare multicast sockets. With a flood, hostile datagrams are sent to both buses in every
// second stretch of the run.
//
//   pose:  bus A ─► dance-join ─UDP─► dance-server ─UDP─► dance-join ─► bus B
//   floor: bus A' ─► bare hop ─UDP─► bare hop ─UDP─► bare hop ─► bus B'
//
// Units/frames: microseconds of this machine's clock; all processes share it.
// Ownership:    owns the processes and their session files, which end with it.
// Failure:      run_bench_path() names the program that could not start, or the way that stayed
//               silent.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/latency/latency_journey.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct BenchPathOptions {
  double hz = 60.0;
  double seconds = 10.0;  // with a flood: half of them during it
  double flood_hz = 0.0;  // hostile datagrams a second; 0: none
};

// Results of one of the measured paths.
struct WayResult {
  std::uint64_t sent = 0;
  std::vector<Duration> took;  // of each that was delivered, sorted

  // fraction in 0..1; 0 where nothing was delivered.
  double percentile_us(double fraction) const;
};

struct BenchPathResult {
  WayResult pose;
  WayResult floor;      // LCM's library
  WayResult raw_floor;  // bare multicast sockets
  GuestJourney steps;   // where the pose's time went
  std::optional<WayResult> flooded_pose;
};

// `own_program` is this program's path: it serves as the bare hops too.
Result<BenchPathResult> run_bench_path(const BenchPathOptions& options,
                                       const std::string& own_program);

std::string bench_path_table(const BenchPathOptions& options, const BenchPathResult& result);
std::string bench_path_json(const BenchPathOptions& options, const BenchPathResult& result);

}  // namespace dance
