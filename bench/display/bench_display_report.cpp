#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/display/bench_display.h"
#include "core/program/figures.h"

namespace dance {
namespace {

double at(std::vector<float>& values, double fraction) {
  std::sort(values.begin(), values.end());
  return static_cast<double>(percentile<float>(values, fraction));
}

nlohmann::json json_of(BenchDisplayWay& way) {
  const auto n = static_cast<double>(way.total_ms.size());
  return {{"p50_ms", at(way.total_ms, 0.5)},  {"p99_ms", at(way.total_ms, 0.99)},
          {"coming_ms", way.coming_ms / n},   {"waiting_ms", way.waiting_ms / n},
          {"drawing_ms", way.drawing_ms / n}, {"swapping_ms", way.swapping_ms / n},
          {"poses", way.total_ms.size()},     {"pictures", way.pictures},
          {"skipped_turns", way.skipped}};
}

}  // namespace

std::string bench_display_table(const BenchDisplayOptions& options, BenchDisplayResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "{} dancers at {:g} Hz, {}x{} pictures by {}, {}\n", options.guests,
                 options.pose_hz, options.width_px, options.height_px, result.renderer,
                 options.in_window ? "in a window"
                                   : fmt::format("a display of {:g} Hz (a clock)", options.hz));
  if (!result.has_waiting_swap)
    fmt::format_to(back, "swap calls do not wait here: there is no turn to be late for\n");
  fmt::format_to(back, "\n  {:<44}{:>16}{:>16}\n", "capture to swap (ms)", "at frame start",
                 "late");
  const auto row = [&](const char* name, double early, double late) {
    fmt::format_to(back, "  {:<44}{:>16.1f}{:>16.1f}\n", name, early, late);
  };
  BenchDisplayWay& early = result.early;
  BenchDisplayWay& late = result.late;
  row("p50", at(early.total_ms, 0.5), at(late.total_ms, 0.5));
  row("p99", at(early.total_ms, 0.99), at(late.total_ms, 0.99));
  const auto n = static_cast<double>(early.total_ms.size());
  const auto m = static_cast<double>(late.total_ms.size());
  row("mean until it was heard", early.coming_ms / n, late.coming_ms / m);
  row("mean until a picture took it", early.waiting_ms / n, late.waiting_ms / m);
  row("mean drawing", early.drawing_ms / n, late.drawing_ms / m);
  row("mean from drawn to the display's turn", early.swapping_ms / n, late.swapping_ms / m);
  row("turns of the display without a new picture, %",
      100.0 * static_cast<double>(early.skipped) /
          static_cast<double>(early.skipped + early.pictures),
      100.0 * static_cast<double>(late.skipped) /
          static_cast<double>(late.skipped + late.pictures));
  return out;
}

std::string bench_display_json(const BenchDisplayOptions& options, BenchDisplayResult& result) {
  nlohmann::json json{{"guests", options.guests},
                      {"display_hz", options.hz},
                      {"pose_hz", options.pose_hz},
                      {"renderer", result.renderer},
                      {"in_window", options.in_window},
                      {"swap_waits", result.has_waiting_swap},
                      {"frame_start", json_of(result.early)},
                      {"late", json_of(result.late)}};
  return json.dump() + "\n";
}

}  // namespace dance
