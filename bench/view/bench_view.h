// Measures the cost of a picture of the stage: the empty floor, mannequins, avatars and places in
// one run, picture by picture in turn, so that a busy machine slows all alike.
//
// Units/frames: milliseconds; pixels.
// Ownership:    plain values.
// Threads:      none inside; draws in the context that it makes.
// Failure:      run_bench_view() names the avatar's file and what is wrong with it, and what is
//               missing for pictures without a display.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "viewer/stage/stage_look.h"

namespace dance {

struct BenchViewOptions {
  int guests = 30;
  std::string avatar;  // a file; "" leaves that row out
  int width_px = 1280;
  int height_px = 720;
  Quality quality = Quality::kHigh;
  double seconds = 10.0;
  bool places = false;  // instead: the guests as mannequins in each place, beside the plain stage
  bool stereo = false;  // each row also for the two eyes of a headset, of that size each
  std::string picture;  // a PNG file of the last picture of the last row; "": none
};

// Sorted, one sample for each picture.
struct BenchViewRow {
  std::string name;
  std::vector<double> retarget_upload_ms;  // posing the figures and handing them to the card
  std::vector<double> submit_ms;  // with the calls to the driver, in the drawing thread alone
  std::vector<double> frame_ms;   // until the card has finished
  std::vector<double> cpu_ms;     // of all threads, the driver's among them
  std::size_t triangles = 0;      // of the last picture
  std::size_t draw_calls = 0;
};

struct BenchViewResult {
  std::string renderer;
  std::vector<BenchViewRow> rows;  // the empty stage first; with places the plain stage
};

Result<BenchViewResult> run_bench_view(const BenchViewOptions& options);

std::string bench_view_table(const BenchViewOptions& options, const BenchViewResult& result);
std::string bench_view_json(const BenchViewOptions& options, const BenchViewResult& result);

}  // namespace dance
