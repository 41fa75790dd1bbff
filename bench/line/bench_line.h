// What `dance bench line` measures: two dancers over each of several lines, most of them at the
// same time, and over a clean one beside them.
//
// Units/frames: figures as bench/line/line_meter.h has them.
// Ownership:    plain values; run_bench_line() owns what runs.
// Threads:      none inside; runs its poller in the caller's thread, where all dancers live.
// Failure:      names the file or the word that is wrong; a signal ends it with an error.
#pragma once

#include <string>
#include <vector>

#include "bench/line/line_lane.h"
#include "core/base/result.h"

namespace dance {

struct BenchLineOptions {
  std::vector<std::string> files;      // traces; UP,DOWN where each way has its own
  LineWords link;                      // what lines do besides: words, no traces
  std::vector<double> offsets_s{0.0};  // each trace from each of these moments on
  double seconds = 60.0;
  double hz = 60.0;
  int at_once = 12;  // lines at a time
};

struct BenchLineResult {
  std::vector<LineResult> lines;  // the clean one first
  double cpu_percent = 0.0;       // of one core, in the busiest batch
};

Result<BenchLineResult> run_bench_line(const BenchLineOptions& options);

// What has to hold over any line: nothing older after something newer, and all know all at the end.
Result<void> check_lines(const BenchLineResult& result);

std::string bench_line_table(const BenchLineOptions& options, const BenchLineResult& result);
std::string bench_line_markdown(const BenchLineOptions& options, const BenchLineResult& result);
std::string bench_line_json(const BenchLineOptions& options, const BenchLineResult& result);

}  // namespace dance
