#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/replay/bench_replay.h"
#include "core/program/figures.h"

namespace dance {
namespace {

double at(const std::vector<double>& sorted, double fraction) {
  return percentile(std::span<const double>(sorted), fraction);
}
double ms(double value) { return rounded(value, 100.0); }

}  // namespace

std::string bench_replay_table(const BenchReplayOptions& options, const BenchReplayResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "{} guests, {:.1f} minutes, {:.1f} MB, its index {:.1f} MB\n", result.guests,
                 result.length_s / 60.0, 1e-6 * static_cast<double>(result.log_bytes),
                 1e-6 * static_cast<double>(result.index_bytes));
  if (options.log.empty())
    fmt::format_to(back, "made in {:.0f} s, intra frames every {:g} s\n", result.made_s,
                   options.night.intra_frame_period.as_seconds());
  fmt::format_to(back, "\n  opened the first time {:>12.0f} ms, of which its index {:.0f}\n",
                 result.open_first_ms, result.index_ms);
  fmt::format_to(back, "\n  {:<22}{:>12}{:>12}{:>12}\n", "ms", "p50", "p99", "worst");
  const auto row = [&](const char* name, const std::vector<double>& samples) {
    fmt::format_to(back, "  {:<22}{:>12.1f}{:>12.1f}{:>12.1f}\n", name, at(samples, 0.5),
                   at(samples, 0.99), at(samples, 1.0));
  };
  row("opened later", result.open_ms);
  row("jump", result.seek_ms);
  if (result.reading_ms.empty()) return out;
  row("reading up to there", result.reading_ms);
  fmt::format_to(back, "\n  scenes that were not the same both ways: {} of {}\n", result.different,
                 result.reading_ms.size());
  return out;
}

std::string bench_replay_json(const BenchReplayOptions& options, const BenchReplayResult& result) {
  nlohmann::ordered_json report{{"guests", result.guests},
                                {"minutes", ms(result.length_s / 60.0)},
                                {"log_bytes", result.log_bytes},
                                {"index_bytes", result.index_bytes}};
  if (options.log.empty()) {
    report["made_s"] = ms(result.made_s);
    report["key_frames_s"] = options.night.intra_frame_period.as_seconds();
    report["arriving"] = options.night.has_arriving;
  }
  report["open_first_ms"] = ms(result.open_first_ms);
  report["index_ms"] = ms(result.index_ms);
  report["open_ms"] = ms(at(result.open_ms, 0.5));
  report["open_ms_max"] = ms(at(result.open_ms, 1.0));
  report["seek_ms_p50"] = ms(at(result.seek_ms, 0.5));
  report["seek_ms_p99"] = ms(at(result.seek_ms, 0.99));
  report["seek_ms_max"] = ms(at(result.seek_ms, 1.0));
  report["seeks"] = result.seek_ms.size();
  if (!result.reading_ms.empty()) {
    report["baseline_reading_ms_p50"] = ms(at(result.reading_ms, 0.5));
    report["baseline_reading_ms_p99"] = ms(at(result.reading_ms, 0.99));
    report["different_scenes"] = result.different;
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
