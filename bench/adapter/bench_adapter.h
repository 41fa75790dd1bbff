// BenchAdapter: what it costs an engine to read a stage through libdance_adapter.so, and how old
// the dancers are that it shows. The house is a real one, `dance join`, in its own process: it
// hears captures from a third process over the bus, stages them and shows them to engines.
//
//   dancers ─ LCM ─► dance-join: manager ─► engine consumer ─ shared memory ─► this process
//
// Units/frames: durations of this machine's clock; all processes share it.
// Ownership:    owns the processes and their session file, which end with it.
// Threads:      none inside but those of the parts that are measured.
// Failure:      run_bench_adapter() names the program that could not start, or that nobody was
//               seen.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/adapter/read_watch.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

struct BenchAdapterOptions {
  std::size_t guests = 30;
  double hz = 90.0;
  double seconds = 5.0;  // of each of its parts
};

using Durations = std::vector<Duration>;

// An engine with that many frames a second, each of which uses its poses late in the frame.
struct FrameLoop {
  double hz = 0.0;
  Durations read_at;          // all dancers for the time of display
  Durations read_again;       // the same at once again, when all is in the processor's caches
  Durations read_newest;      // all dancers as they came
  Durations copied;           // as many bytes, copied
  Durations drained;          // the same dancers received over a hop of the bus
  Durations age_late;         // at their use, asked for then
  Durations age_early;        // at their use, asked for when the frame began
  Durations age_other_early;  // the same from the hop of the bus
};

// Of a reader that spins: how old a pose is when it is seen.
struct Spin {
  Durations staged;
  Durations captured;
  Durations on_processor;  // of `staged`: those during which the reader was not put aside
};

struct BenchAdapterResult {
  Spin memory;               // from the write, with nothing else running
  Spin house;                // from the stage of the house, another process, with all running
  Durations capture_to_lcm;  // received by another program over a further hop of the bus
  std::vector<FrameLoop> loops;
  std::uint64_t reads = 0;
  std::uint64_t torn = 0;
  std::uint64_t gave_up = 0;  // calls that were answered with DANCE_BUSY
  ReadWatch watch;            // of the frame loops' reads, each of all dancers
};

// `own_program` is this program's path: it serves as the dancers too.
Result<BenchAdapterResult> run_bench_adapter(const BenchAdapterOptions& options,
                                             const std::string& own_program);
// The dancers: captures of `guests` dancers on the bus, one after the other, until a signal comes.
Result<void> run_dancers(const std::string& bus_url, std::size_t guests, double hz);

std::string bench_adapter_table(const BenchAdapterOptions& options, BenchAdapterResult& result);
std::string bench_adapter_json(const BenchAdapterOptions& options, BenchAdapterResult& result);

}  // namespace dance
