#include "apps/crowd/crowd_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apps/crowd/crowd_guest.h"
#include "core/program/figures.h"

namespace dance {
namespace {

constexpr double kTenths = 10.0, kHundredths = 100.0, kMillionths = 1e6;

// Per second and guest who is there.
double rate_of_each(std::uint64_t n, const CrowdTally& tally) {
  return static_cast<double>(n) / static_cast<double>(std::max<std::uint64_t>(tally.present, 1));
}

double us_a_pose(double cpu_s, const CrowdTally& tally) {
  return tally.delivered == 0 ? 0.0 : cpu_s * 1e6 / static_cast<double>(tally.delivered);
}

nlohmann::ordered_json json_of(const CrowdTally& tally, std::uint64_t present) {
  const Histogram& latency = tally.latency;
  return {{"present", present},
          {"sent", tally.sent},
          {"unsent", tally.unsent},
          {"skipped", tally.skipped},
          {"delivered", tally.delivered},
          {"missed", tally.missed},
          {"lost", tally.lost},
          {"undecodable", tally.undecodable},
          {"delivered_share", rounded(tally.share(), kMillionths)},
          {"near_share", rounded(tally.near_share(), kMillionths)},
          {"far_share", rounded(tally.far_share(), kMillionths)},
          {"p50_us", rounded(latency.percentile(0.50).as_us(), kTenths)},
          {"p90_us", rounded(latency.percentile(0.90).as_us(), kTenths)},
          {"p99_us", rounded(latency.percentile(0.99).as_us(), kTenths)},
          {"worst_us", rounded(latency.max().as_us(), kTenths)},
          {"bytes_per_s_up_per_guest", rounded(rate_of_each(tally.bytes_up, tally), kTenths)},
          {"bytes_per_s_down_per_guest", rounded(rate_of_each(tally.bytes_down, tally), kTenths)},
          {"datagrams_per_s_up_per_guest",
           rounded(rate_of_each(tally.datagrams_up, tally), kHundredths)},
          {"datagrams_per_s_down_per_guest",
           rounded(rate_of_each(tally.datagrams_down, tally), kHundredths)},
          {"lapses", tally.lapses},
          {"reconnects", tally.reconnects},
          {"left", tally.left}};
}

}  // namespace

std::string crowd_heading() {
  return fmt::format("{:>6}{:>9}{:>9}{:>11}{:>11}{:>9}{:>9}{:>9}{:>10}{:>9}{:>9}{:>8}{:>8}\n", "s",
                     "present", "sent", "delivered", "share", "p50 µs", "p90 µs", "p99 µs",
                     "worst µs", "up kB", "down kB", "lapses", "back");
}

std::string crowd_second_line(const CrowdSecond& second) {
  const CrowdTally& tally = second.tally;
  const auto us = [&](double fraction) { return tally.latency.percentile(fraction).as_us(); };
  return fmt::format(
      "{:>6}{:>9}{:>9}{:>11}{:>10.3f}%{:>8.0f}{:>8.0f}{:>8.0f}{:>9.0f}{:>9.2f}{:>9.2f}{:>8}{:>8}\n",
      second.is_measured ? std::to_string(second.second) : fmt::format("({})", second.second),
      tally.present, tally.sent, tally.delivered, 100.0 * tally.share(), us(0.50), us(0.90),
      us(0.99), tally.latency.max().as_us(), rate_of_each(tally.bytes_up, tally) * 1e-3,
      rate_of_each(tally.bytes_down, tally) * 1e-3, tally.lapses, tally.reconnects);
}

std::string crowd_second_json(const CrowdSecond& second) {
  nlohmann::ordered_json json{{"second", second.second}, {"measured", second.is_measured}};
  json.update(json_of(second.tally, second.tally.present));
  return json.dump() + "\n";
}

std::string crowd_summary_text(const CrowdPlan& plan, const CrowdSummary& summary) {
  const CrowdTally& tally = summary.tally;
  const auto us = [&](double fraction) { return tally.latency.percentile(fraction).as_us(); };
  const auto each = [&](std::uint64_t n) { return rate_of_each(n, tally); };
  std::string out;
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "\n{} guests in {} {}, {:g} Hz, {} s\n", plan.guests, plan.rooms,
                 plan.rooms == 1 ? "room" : "rooms", plan.hz, summary.seconds);
  fmt::format_to(back,
                 "  poses               {} sent, {} delivered, {} missed ({} lost on the way, {} "
                 "undecodable): {:.4f} %\n",
                 tally.sent, tally.delivered, tally.missed, tally.lost, tally.undecodable,
                 100.0 * tally.share());
  fmt::format_to(
      back, "  near and far        {:.4f} % of the {} nearest guests, {:.4f} % of the others\n",
      100.0 * tally.near_share(), kNearGuests, 100.0 * tally.far_share());
  fmt::format_to(back, "  guest to guest, µs  p50 {:.0f}, p90 {:.0f}, p99 {:.0f}, worst {:.0f}\n",
                 us(0.50), us(0.90), us(0.99), tally.latency.max().as_us());
  fmt::format_to(back,
                 "  a guest, a second   up {:.2f} kB in {:.1f} datagrams, down {:.2f} kB in {:.1f} "
                 "datagrams\n",
                 each(tally.bytes_up) * 1e-3, each(tally.datagrams_up),
                 each(tally.bytes_down) * 1e-3, each(tally.datagrams_down));
  fmt::format_to(back,
                 "  guests              {} present, {} lapses, {} reconnects, {} left to come "
                 "back\n",
                 summary.present, tally.lapses, tally.reconnects, tally.left);
  const double seconds = static_cast<double>(std::max<std::int64_t>(summary.seconds, 1));
  if (summary.knows_server_cpu)
    fmt::format_to(back,
                   "  servers             {:.1f} % of a core, {:.3f} µs of it a delivered pose\n",
                   100.0 * summary.server_cpu_s / seconds, us_a_pose(summary.server_cpu_s, tally));
  fmt::format_to(back, "  this program        {:.1f} % of a core\n",
                 100.0 * summary.own_cpu_s / seconds);
  if (tally.skipped > 0 || tally.unsent > 0)
    fmt::format_to(
        back,
        "  not danced          {} poses for which this machine had no time, {} without a "
        "session\n",
        tally.skipped, tally.unsent);
  return out;
}

std::string crowd_summary_json(const CrowdPlan& plan, const CrowdSummary& summary) {
  nlohmann::ordered_json json{
      {"summary", true},     {"guests", plan.guests},
      {"rooms", plan.rooms}, {"servers", std::max<std::size_t>(plan.servers.size(), 1)},
      {"hz", plan.hz},       {"seconds", summary.seconds}};
  json.update(json_of(summary.tally, summary.present));
  const double seconds = static_cast<double>(std::max<std::int64_t>(summary.seconds, 1));
  if (summary.knows_server_cpu) {
    json["server_cpu_percent"] = rounded(100.0 * summary.server_cpu_s / seconds, kHundredths);
    json["server_us_per_delivered_pose"] =
        rounded(us_a_pose(summary.server_cpu_s, summary.tally), 1e4);
  }
  json["own_cpu_percent"] = rounded(100.0 * summary.own_cpu_s / seconds, kHundredths);
  return json.dump() + "\n";
}

}  // namespace dance
