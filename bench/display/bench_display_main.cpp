// dance-bench-display: from capture to the display's turn, poses taken late against at frame start.

#include <cstdio>

#include "bench/display/bench_display.h"
#include "core/program/program.h"
#include "viewer/program/view_options.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench display
  dance bench display --hz 120 --guests 8 --size 320x180 --json
  dance bench display --window            on this machine's own display
Both ways run by turns of two seconds. Off screen the display is a clock whose swap returns at its
next turn; drawing, poses and threads are real.
)";

struct Wishes {
  BenchDisplayOptions bench;
  std::string size = "640x360";
  bool is_json = false;
};

Result<void> run(Wishes& wishes) {
  DANCE_TRY(BenchDisplayResult result, run_bench_display(wishes.bench));
  const std::string text = wishes.is_json ? bench_display_json(wishes.bench, result)
                                          : bench_display_table(wishes.bench, result);
  std::fputs(text.c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line(
      "From capture to the display's turn: poses taken late, or at frame start.",
      "dance bench display");
  line.add("--hz", wishes.bench.hz, "turns of the display a second")
      .range(20.0, 480.0)
      .shows_default();
  line.add("--pose-hz", wishes.bench.pose_hz, "poses a second of each dancer")
      .range(1.0, 240.0)
      .shows_default();
  line.add("--guests", wishes.bench.guests, "dancers").range(1.0, 64.0).shows_default();
  line.add("--size", wishes.size, "of the pictures").shows_default();
  line.add("--seconds", wishes.bench.seconds, "how long to measure")
      .range(4.0, 3600.0)
      .shows_default();
  line.add_flag("--window", wishes.bench.in_window, "in a window, by its display's own turns");
  line.add_flag("--json", wishes.is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  line.finally([&]() -> dance::Result<void> {
    DANCE_TRY(const dance::ViewPictureSize size, dance::parse_size(wishes.size));
    wishes.bench.width_px = size.width_px;
    wishes.bench.height_px = size.height_px;
    return {};
  });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
