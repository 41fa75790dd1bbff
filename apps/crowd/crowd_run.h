// Runs a crowd: opens its doors, starts its threads, waits until everybody is in, measures, and
// says each second and at the end what came of it.
//
// Units/frames: processor time is that of the servers that are known: its own, and those that the
//               plan names.
// Ownership:    owns threads and its own server, which end with it.
// Threads:      the caller's, and those of the plan.
// Failure:      run_crowd() names what keeps guests out, or that this machine has too few open
//               files; a signal ends it early, with what was measured so far.
#pragma once

#include <functional>

#include "apps/crowd/crowd_plan.h"
#include "apps/crowd/crowd_tally.h"
#include "core/base/time.h"

namespace dance {

struct CrowdSecond {
  std::int64_t second = 0;  // from 1
  bool is_measured = false;
  CrowdTally tally;
};

struct CrowdSummary {
  std::int64_t seconds = 0;  // measured
  CrowdTally tally;
  std::uint64_t present = 0;  // guests, at the end
  bool knows_server_cpu = false;
  double server_cpu_s = 0.0;
  double own_cpu_s = 0.0;
};

Result<CrowdSummary> run_crowd(const CrowdPlan& plan,
                               const std::function<void(const CrowdSecond&)>& tell);

}  // namespace dance
