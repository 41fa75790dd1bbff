// dance bench display: from capture to the display's turn, with poses taken at the beginning of
// each frame, as the window once did, and taken as late as drawing allows, in one run and by turns.
//
// Poses come from another thread at their own rate, through the same board as in the window; they
// are drawn for real, off screen. The display is a clock: a swap returns at its next turn, as with
// a monitor and two buffers. With a window on a display that makes swap calls wait, that is used.
//
// Units/frames: ms.
// Ownership:    plain values.
// Threads:      run_bench_display() starts one that captures and ends it.
// Failure:      the Error names what display or driver refuse.
#pragma once

#include <string>

#include "core/base/result.h"
#include "viewer/display/display_path.h"
#include "viewer/display/swap_meter.h"

namespace dance {

struct BenchDisplayOptions {
  double hz = 60.0;       // of the display
  double pose_hz = 60.0;  // of each dancer
  int guests = 2;
  int width_px = 640;
  int height_px = 360;
  double seconds = 20.0;  // of both together
  bool in_window = false;
};

struct BenchDisplayWay {
  std::vector<float> total_ms;  // of each pose: capture to the turn that showed it
  double coming_ms = 0.0, waiting_ms = 0.0, drawing_ms = 0.0, swapping_ms = 0.0;  // sums
  std::uint64_t pictures = 0;
  std::uint64_t skipped = 0;  // turns of the display without a new picture
};

struct BenchDisplayResult {
  BenchDisplayWay early;
  BenchDisplayWay late;
  std::string renderer;
  bool has_waiting_swap = true;  // false: nothing to be late for
};

Result<BenchDisplayResult> run_bench_display(const BenchDisplayOptions& options);
std::string bench_display_table(const BenchDisplayOptions& options, BenchDisplayResult& result);
std::string bench_display_json(const BenchDisplayOptions& options, BenchDisplayResult& result);

}  // namespace dance
