#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/bench_tunnel.h"
#include "tools/figures.h"
#include "tunnel/server_state.h"

namespace dance {
namespace {

nlohmann::ordered_json json_of(const TunnelWay& way) {
  return {{"sent", way.sent},
          {"delivered", way.delivered},
          {"p50_us", rounded(way.percentile_us(0.50), 10.0)},
          {"p95_us", rounded(way.percentile_us(0.95), 10.0)},
          {"p99_us", rounded(way.percentile_us(0.99), 10.0)},
          {"max_us", rounded(way.percentile_us(1.0), 10.0)},
          {"server_cpu_percent", rounded(way.server_cpu_percent, 100.0)},
          {"server_idle_cpu_percent", rounded(way.idle_cpu_percent, 100.0)},
          {"bytes_per_second_down_per_guest", std::round(way.down_bytes_per_s)}};
}

}  // namespace

std::string bench_tunnel_table(const BenchTunnelOptions& options, const TunnelWays& ways) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back,
                 "guest to server to guest on this machine, {} guests, {:g} Hz, {:g} s each, turn "
                 "about (µs)\n\n",
                 options.guests, options.hz, options.seconds);
  const double window_ms =
      options.share_ms >= 0.0 ? options.share_ms : share_window_of(options.guests).as_ms();
  if (window_ms > 0.0)
    fmt::format_to(back,
                   "  the server lets poses wait up to {:g} ms for others to share a datagram with "
                   "(--share-ms)\n\n",
                   window_ms);
  fmt::format_to(back, "  {:<18}{:>8}{:>8}{:>8}{:>9}{:>10}{:>11}{:>8}{:>8}{:>10}\n", "", "p50",
                 "p95", "p99", "max", "sent", "delivered", "cpu %", "idle %", "kB/s down");
  for (const TunnelWay& way : ways)
    fmt::format_to(
        back, "  {:<18}{:>8.0f}{:>8.0f}{:>8.0f}{:>9.0f}{:>10}{:>10.3f}%{:>8.1f}{:>8.2f}{:>10.1f}\n",
        way.title, way.percentile_us(0.50), way.percentile_us(0.95), way.percentile_us(0.99),
        way.percentile_us(1.0), way.sent,
        way.sent > 0 ? 100.0 * static_cast<double>(way.delivered) / static_cast<double>(way.sent)
                     : 0.0,
        way.server_cpu_percent, way.idle_cpu_percent, way.down_bytes_per_s * 1e-3);
  out += '\n';
  for (std::size_t i = 1; i < ways.size(); ++i)
    fmt::format_to(back, "  {:<18}{:>7.2f}×{:>7.2f}×{:>7.2f}×\n", "by " + ways[i].title,
                   ways[0].percentile_us(0.50) / ways[i].percentile_us(0.50),
                   ways[0].percentile_us(0.95) / ways[i].percentile_us(0.95),
                   ways[0].percentile_us(0.99) / ways[i].percentile_us(0.99));
  return out;
}

std::string bench_tunnel_json(const BenchTunnelOptions& options, const TunnelWays& ways) {
  nlohmann::ordered_json report{{"guests", options.guests}, {"hz", options.hz}};
  for (const TunnelWay& way : ways) {
    if (way.name.empty())
      report.update(json_of(way));
    else
      report[way.name] = json_of(way);
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
