// BenchHeadset: how long it takes from when a headset's sensors are asked for to the link
// that sends the pose on, with the real programs: dance headset behind OpenXR's loader and the test
// runtime, a house, a server and a second house. Beside it, in the same house and at the same rate,
// a synthetic dancer, whose pose costs nothing to find.
//
// Units/frames: microseconds of this machine's clock; all processes share it.
// Ownership:    owns the processes and their session files, which end with it.
// Threads:      none inside; runs its poller in the caller's thread.
// Failure:      run_bench_headset() names the program that ended, or that stayed silent.
#pragma once

#include <string>

#include "apps/latency/latency_journey.h"
#include "core/base/result.h"

namespace dance {

struct BenchHeadsetOptions {
  double hz = 90.0;
  double seconds = 10.0;
  bool learned = true;  // the body, else by rules
};

struct BenchHeadsetResult {
  GuestJourney headset;
  GuestJourney synthetic;
};

Result<BenchHeadsetResult> run_bench_headset(const BenchHeadsetOptions& options);
std::string bench_headset_table(const BenchHeadsetOptions& options,
                                const BenchHeadsetResult& result);

}  // namespace dance
