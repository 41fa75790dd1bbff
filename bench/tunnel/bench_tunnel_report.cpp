#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/tunnel/bench_tunnel.h"
#include "core/program/figures.h"

namespace dance {
namespace {

nlohmann::ordered_json json_of(const TunnelMeasure& measure, double idle_cpu_percent) {
  using nlohmann::ordered_json;
  ordered_json report{{"sent", measure.sent},
                      {"delivered", measure.delivered},
                      {"p50_us", rounded(measure.percentile_us(0.50), 10.0)},
                      {"p95_us", rounded(measure.percentile_us(0.95), 10.0)},
                      {"p99_us", rounded(measure.percentile_us(0.99), 10.0)},
                      {"max_us", rounded(measure.percentile_us(1.0), 10.0)},
                      {"server_cpu_percent", rounded(measure.server_cpu_percent, 100.0)},
                      {"server_idle_cpu_percent", rounded(idle_cpu_percent, 100.0)},
                      {"bytes_per_second_down_per_guest", std::round(measure.down_bytes_per_s)},
                      {"payload_bytes_per_pose", rounded(measure.payload_bytes, 100.0)},
                      {"overhead_bytes_per_pose_up", rounded(measure.overhead_up, 100.0)},
                      {"overhead_bytes_per_pose_down", rounded(measure.overhead_down, 100.0)}};
  if (measure.voices_share > 0.0)
    report["voices"] = {
        {"delivered_share", rounded(measure.voices_share, 1e5)},
        {"p50_us", rounded(measure.voice_percentile_us(0.50), 10.0)},
        {"p99_us", rounded(measure.voice_percentile_us(0.99), 10.0)},
        {"bytes_per_second_up_per_talker", std::round(measure.voice_up_bytes_per_s)},
        {"bytes_per_second_down_per_guest", std::round(measure.voice_down_bytes_per_s)}};
  return report;
}

nlohmann::ordered_json json_of_all(const TunnelWays& ways, TunnelMeasure TunnelWay::*dance) {
  nlohmann::ordered_json report;
  for (const TunnelWay& way : ways) {
    const auto json = json_of(way.*dance, way.idle_cpu_percent);
    if (way.name.empty())
      report.update(json);
    else
      report[way.name] = json;
  }
  return report;
}

void add_rows(const TunnelWays& ways, TunnelMeasure TunnelWay::*dance, std::string& out) {
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "  {:<16}{:>7}{:>7}{:>7}{:>8}{:>9}{:>11}{:>7}{:>8}{:>10}{:>9}{:>7}{:>7}\n",
                 "", "p50", "p95", "p99", "max", "sent", "delivered", "cpu %", "idle %",
                 "kB/s down", "payload", "+ up", "+ down");
  for (const TunnelWay& way : ways) {
    const TunnelMeasure& m = way.*dance;
    const double share =
        m.sent > 0 ? static_cast<double>(m.delivered) / static_cast<double>(m.sent) : 0.0;
    fmt::format_to(
        back,
        "  {:<16}{:>7.0f}{:>7.0f}{:>7.0f}{:>8.0f}{:>9}{:>10.3f}%{:>7.1f}{:>8.2f}{:>10.1f}"
        "{:>9.1f}{:>7.1f}{:>7.1f}\n",
        way.title, m.percentile_us(0.50), m.percentile_us(0.95), m.percentile_us(0.99),
        m.percentile_us(1.0), m.sent, 100.0 * share, m.server_cpu_percent, way.idle_cpu_percent,
        m.down_bytes_per_s * 1e-3, m.payload_bytes, m.overhead_up, m.overhead_down);
  }
  const TunnelMeasure& ours = ways[0].*dance;
  for (std::size_t i = 1; i < ways.size(); ++i) {
    const TunnelMeasure& theirs = ways[i].*dance;
    fmt::format_to(back, "  {:<16}{:>6.2f}×{:>6.2f}×{:>6.2f}×\n", "by " + ways[i].title,
                   ours.percentile_us(0.50) / theirs.percentile_us(0.50),
                   ours.percentile_us(0.95) / theirs.percentile_us(0.95),
                   ours.percentile_us(0.99) / theirs.percentile_us(0.99));
  }
}

void add_voices(const TunnelWays& ways, TunnelMeasure TunnelWay::*dance, std::string& out) {
  const TunnelMeasure &alone = ways.front().*dance, &again = ways[1].*dance,
                      &with = ways.back().*dance;
  const auto ratio = [&](const TunnelMeasure& of, double fraction) {
    return of.percentile_us(fraction) / alone.percentile_us(fraction);
  };
  fmt::format_to(
      std::back_inserter(out),
      "  poses with voices by without: p50 {:.2f}×, p99 {:.2f}×; by the noise of the same "
      "again: {:.2f}×, {:.2f}×\n"
      "  voices: {:.3f}% delivered, p50 {:.0f}, p99 {:.0f} µs; {:.1f} kB/s up of each who "
      "speaks, {:.1f} kB/s down to each guest; {:.1f}% more of a core at the server\n",
      ratio(with, 0.50), ratio(with, 0.99), ratio(again, 0.50), ratio(again, 0.99),
      100.0 * with.voices_share, with.voice_percentile_us(0.50), with.voice_percentile_us(0.99),
      with.voice_up_bytes_per_s * 1e-3, with.voice_down_bytes_per_s * 1e-3,
      with.server_cpu_percent - alone.server_cpu_percent);
}

}  // namespace

std::string bench_tunnel_table(const BenchTunnelOptions& options, const TunnelWays& ways) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(
      back,
      "guest to server to guest on this machine, {} guests, {:g} Hz, {:g} s each, turn about; µs, "
      "and bytes of a pose\n\neverybody at the same moment\n",
      options.guests, options.hz, options.seconds);
  add_rows(ways, &TunnelWay::together, out);
  if (options.voices > 0) add_voices(ways, &TunnelWay::together, out);
  out += "\nspread evenly over the frame";
  if (options.share_ms > 0.0)
    fmt::format_to(back,
                   "; the server lets poses wait up to {:g} ms to share a datagram (--share-ms)",
                   options.share_ms);
  out += '\n';
  add_rows(ways, &TunnelWay::spread, out);
  if (options.voices > 0) add_voices(ways, &TunnelWay::spread, out);
  return out;
}

std::string bench_tunnel_json(const BenchTunnelOptions& options, const TunnelWays& ways) {
  nlohmann::ordered_json report{{"guests", options.guests}, {"hz", options.hz}};
  report.update(json_of_all(ways, &TunnelWay::together));
  report["spread"] = json_of_all(ways, &TunnelWay::spread);
  return report.dump(2) + "\n";
}

}  // namespace dance
