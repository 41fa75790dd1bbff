#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/latency/latency_report.h"
#include "bench/path/bench_path.h"
#include "core/program/figures.h"

namespace dance {
namespace {

double ratio(const WayResult& way, const WayResult& floor, double fraction) {
  const double floor_us = floor.percentile_us(fraction);
  return floor_us > 0.0 ? way.percentile_us(fraction) / floor_us : 0.0;
}

}  // namespace

std::string bench_path_table(const BenchPathOptions& options, const BenchPathResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back,
                 "capture on one house's bus to stage on the other's, {:g} Hz, {:g} s (µs)\n\n",
                 options.hz, options.seconds);
  fmt::format_to(back, "  {:<28}{:>9}{:>9}{:>9}{:>9}{:>9}{:>11}\n", "", "p50", "p95", "p99", "max",
                 "sent", "delivered");
  const auto row = [&](const char* name, const WayResult& way) {
    fmt::format_to(back, "  {:<28}{:>9.0f}{:>9.0f}{:>9.0f}{:>9.0f}{:>9}{:>11}\n", name,
                   way.percentile_us(0.50), way.percentile_us(0.95), way.percentile_us(0.99),
                   way.percentile_us(1.0), way.sent, way.took.size());
  };
  row("a pose", result.pose);
  row("as many bare hops, LCM", result.floor);
  row("as many bare hops, sockets", result.raw_floor);
  const auto ratios = [&](const char* name, const WayResult& way, const WayResult& floor) {
    fmt::format_to(back, "  {:<28}{:>9.2f}{:>9.2f}{:>9.2f}\n", name, ratio(way, floor, 0.50),
                   ratio(way, floor, 0.95), ratio(way, floor, 0.99));
  };
  ratios("times the floor of LCM", result.pose, result.floor);
  ratios("times the floor of sockets", result.pose, result.raw_floor);
  if (result.flooded_pose) {
    row(fmt::format("a pose, {:g} hostile a s", options.flood_hz).c_str(), *result.flooded_pose);
    ratios("times a pose without them", *result.flooded_pose, result.pose);
  }
  out += "\n";
  out += "where the pose's time went:\n";
  out += journey_table(result.steps);
  return out;
}

std::string bench_path_json(const BenchPathOptions& options, const BenchPathResult& result) {
  nlohmann::ordered_json report{{"hz", options.hz}, {"seconds", options.seconds}};
  const auto add = [&](const std::string& prefix, const WayResult& way) {
    report[prefix + "sent"] = way.sent;
    report[prefix + "delivered"] = way.took.size();
    for (const auto& [key, fraction] :
         {std::pair{"p50_us", 0.50}, {"p95_us", 0.95}, {"p99_us", 0.99}, {"max_us", 1.0}})
      report[prefix + key] = rounded(way.percentile_us(fraction), 10.0);
  };
  add("", result.pose);
  add("floor_", result.floor);
  add("raw_floor_", result.raw_floor);
  const auto add_ratios = [&](const std::string& prefix, const WayResult& way,
                              const WayResult& floor) {
    report[prefix + "ratio_p50"] = rounded(ratio(way, floor, 0.50), 1000.0);
    report[prefix + "ratio_p99"] = rounded(ratio(way, floor, 0.99), 1000.0);
  };
  add_ratios("", result.pose, result.floor);
  add_ratios("raw_", result.pose, result.raw_floor);
  if (result.flooded_pose) {
    report["flood_hz"] = options.flood_hz;
    add("flooded_", *result.flooded_pose);
    add_ratios("flooded_", *result.flooded_pose, result.pose);
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
