// How fast a long recorded night opens, the first time and later, and how fast a player jumps in
// it, beside reading the log from its beginning to the same moments.
//
// Units/frames: milliseconds.
// Ownership:    plain values.
// Threads:      none inside, but those of ReplayFeed and of make_night_log().
// Failure:      names the log that cannot be made or read.
#pragma once

#include <string>
#include <vector>

#include "bench/replay/night_log.h"

namespace dance {

struct BenchReplayOptions {
  NightWish night;
  std::string log;  // "": one is made, and removed at the end
  int seeks = 200;
  int opens = 5;
  bool has_baseline = true;
};

// Samples are sorted.
struct BenchReplayResult {
  std::size_t guests = 0;
  double length_s = 0.0;
  std::uint64_t log_bytes = 0, index_bytes = 0;
  double made_s = 0.0;         // 0: the log was there
  double index_ms = 0.0;       // to look through it and keep the index
  double open_first_ms = 0.0;  // that, and the first scene
  std::vector<double> open_ms;
  std::vector<double> seek_ms;
  std::vector<double> reading_ms;  // from the beginning to the same moments
  std::size_t different = 0;       // scenes that were not the same both ways
};

Result<BenchReplayResult> run_bench_replay(const BenchReplayOptions& options);

std::string bench_replay_table(const BenchReplayOptions& options, const BenchReplayResult& result);
std::string bench_replay_json(const BenchReplayOptions& options, const BenchReplayResult& result);

}  // namespace dance
