#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/tunnel/bench_flood.h"
#include "core/program/figures.h"

namespace dance {
namespace {

double us_of(const FloodPhase& phase, double fraction) {
  return percentile<Duration>(phase.took, fraction).as_us();
}

double delivered_percent(const FloodPhase& phase) {
  return phase.sent > 0
             ? 100.0 * static_cast<double>(phase.delivered) / static_cast<double>(phase.sent)
             : 0.0;
}

}  // namespace

std::string bench_flood_table(const BenchFloodOptions& options, const FloodResult& result) {
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back,
                 "a couple at {:g} Hz beside {} hostile datagrams, {:g} a second, from {} "
                 "addresses of this machine\n\n",
                 options.hz, result.attack.all_sent(), options.per_second, options.sources);
  fmt::format_to(back, "  {:<8}{:>9}{:>11}{:>9}{:>9}{:>14}{:>16}\n", "", "sent", "delivered",
                 "p50 µs", "p99 µs", "server cpu %", "server memory");
  for (const FloodPhase& phase : result.phases)
    fmt::format_to(back, "  {:<8}{:>9}{:>10.3f}%{:>9.0f}{:>9.0f}{:>14.1f}{:>13} kB\n", phase.name,
                   phase.sent, delivered_percent(phase), us_of(phase, 0.5), us_of(phase, 0.99),
                   phase.server_cpu_percent, phase.server_rss_kb);
  out += "\n  sent against it:\n";
  for (std::size_t i = 0; i < kAttacks; ++i)
    fmt::format_to(back, "    {:<28}{:>10}\n", kAttackNames[i], result.attack.sent[i]);
  fmt::format_to(back, "  answered: {:.4f} bytes for each byte; let in with a wrong key: {}\n",
                 static_cast<double>(result.attack.bytes_answered) /
                     std::max(1.0, static_cast<double>(result.attack.bytes_sent)),
                 result.attack.let_in);
  out += "\n  kept out, by cause:\n";
  for (const auto& [cause, count] : result.kept_out)
    if (count > 0) fmt::format_to(back, "    {:<28}{:>10}\n", cause, count);
  fmt::format_to(back, "\n  the server {}; poses after a newer one: {}\n",
                 result.has_server_ended ? "ENDED" : "stands", result.poses_shown_old);
  return out;
}

std::string bench_flood_json(const BenchFloodOptions& options, const FloodResult& result) {
  nlohmann::ordered_json json{{"hz", options.hz},
                              {"datagrams", result.attack.all_sent()},
                              {"datagrams_per_second", options.per_second},
                              {"sources", options.sources}};
  for (const FloodPhase& phase : result.phases)
    json[phase.name] = {{"sent", phase.sent},
                        {"delivered", phase.delivered},
                        {"p50_us", rounded(us_of(phase, 0.5), 10.0)},
                        {"p99_us", rounded(us_of(phase, 0.99), 10.0)},
                        {"server_cpu_percent", rounded(phase.server_cpu_percent, 10.0)},
                        {"server_rss_kb", phase.server_rss_kb}};
  for (std::size_t i = 0; i < kAttacks; ++i)
    json["attacks"][std::string(kAttackNames[i])] = result.attack.sent[i];
  json["bytes_sent"] = result.attack.bytes_sent;
  json["bytes_answered"] = result.attack.bytes_answered;
  json["let_in"] = result.attack.let_in;
  for (const auto& [cause, count] : result.kept_out) json["kept_out"][cause] = count;
  json["server_ended"] = result.has_server_ended;
  json["poses_shown_old"] = result.poses_shown_old;
  return json.dump() + "\n";
}

}  // namespace dance
