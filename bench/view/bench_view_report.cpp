#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/view/bench_view.h"
#include "core/program/figures.h"

namespace dance {
namespace {

double at(const std::vector<double>& sorted, double fraction) {
  return percentile(std::span<const double>(sorted), fraction);
}

// The ratio of one row to the first, the plain stage. Processor time is steadier on a busy machine.
double ratio_to_plain(const BenchViewResult& result, const BenchViewRow& row) {
  return at(row.frame_ms, 0.5) / at(result.rows.front().frame_ms, 0.5);
}
double cpu_ratio_to_plain(const BenchViewResult& result, const BenchViewRow& row) {
  return at(row.cpu_ms, 0.5) / at(result.rows.front().cpu_ms, 0.5);
}

nlohmann::ordered_json json_of(const BenchViewRow& row) {
  const auto ms = [](double value) { return rounded(value, 1000.0); };
  return {{"cpu_ms_per_frame_p50", ms(at(row.cpu_ms, 0.5))},
          {"retarget_upload_ms_p50", ms(at(row.retarget_upload_ms, 0.5))},
          {"submit_ms_p50", ms(at(row.submit_ms, 0.5))},
          {"frame_ms_p50", ms(at(row.frame_ms, 0.5))},
          {"frame_ms_p99", ms(at(row.frame_ms, 0.99))},
          {"frame_ms_min", ms(at(row.frame_ms, 0.0))},
          {"triangles", row.triangles},
          {"draw_calls", row.draw_calls},
          {"frames", row.frame_ms.size()}};
}

}  // namespace

std::string bench_view_table(const BenchViewOptions& options, const BenchViewResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(
      back, "{} guests, {}x{}, quality {}, on {}\n(ms a picture, with all that the card does)\n\n",
      options.guests, options.width_px, options.height_px,
      options.quality == Quality::kLow ? "low" : "high", result.renderer);
  fmt::format_to(back, "  {:<20}{:>9}{:>9}{:>9}{:>9}{:>11}{:>9}{:>12}{:>8}{:>9}\n", "", "p50",
                 "p99", "best", "cpu", "pose, load", "submit", "triangles", "calls", "frames");
  for (const BenchViewRow& row : result.rows)
    fmt::format_to(back,
                   "  {:<20}{:>9.2f}{:>9.2f}{:>9.2f}{:>9.2f}{:>11.3f}{:>9.2f}{:>12}{:>8}{:>9}\n",
                   row.name, at(row.frame_ms, 0.5), at(row.frame_ms, 0.99), at(row.frame_ms, 0.0),
                   at(row.cpu_ms, 0.5), at(row.retarget_upload_ms, 0.5), at(row.submit_ms, 0.5),
                   row.triangles, row.draw_calls, row.frame_ms.size());
  if (!options.places) return out;
  for (const BenchViewRow& row : result.rows)
    if (&row != &result.rows.front())
      fmt::format_to(back, "  {} / plain: {:.3f}, of processor time {:.3f}\n", row.name,
                     ratio_to_plain(result, row), cpu_ratio_to_plain(result, row));
  return out;
}

// The last row's figures in front, as that is what was asked for; then all rows by name.
std::string bench_view_json(const BenchViewOptions& options, const BenchViewResult& result) {
  nlohmann::ordered_json report{{"guests", options.guests},
                                {"size", fmt::format("{}x{}", options.width_px, options.height_px)},
                                {"quality", options.quality == Quality::kLow ? "low" : "high"},
                                {"renderer", result.renderer}};
  report.update(json_of(result.rows.back()));
  for (const BenchViewRow& row : result.rows) report[row.name] = json_of(row);
  if (options.places)
    for (const BenchViewRow& row : result.rows)
      report[row.name].update(
          {{"ratio_to_plain", rounded(ratio_to_plain(result, row), 1000.0)},
           {"cpu_ratio_to_plain", rounded(cpu_ratio_to_plain(result, row), 1000.0)}});
  return report.dump(2) + "\n";
}

}  // namespace dance
