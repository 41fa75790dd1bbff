#include "apps/demo/demo_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace dance {
namespace {

using nlohmann::ordered_json;

constexpr std::array<const char*, kHopCount> kHopNames{"published",     "link_sent", "server",
                                                       "link_received", "on_stage",  "staged"};
// The report of the receiving house's link on this dancer, if it was not killed.
ordered_json link_report(const DemoResult& result, const DancerAccount& account) {
  const std::string& text = result.house_reports[1 - account.house];
  const auto report = ordered_json::parse(text, nullptr, false);
  if (!report.is_object() || !report.contains("guests")) return {};
  for (const auto& guest : report["guests"])
    if (guest.value("id", "") == account.guest.view()) return guest;
  return {};
}

// Sent, and not delivered, by cause. What no counter explains was lost while a program was
// restarted or on the buses.
std::map<std::string, std::int64_t> losses(const DemoResult& result, const DancerAccount& account) {
  std::map<std::string, std::int64_t> causes;
  std::int64_t missing = std::max<std::int64_t>(0, account.sent - account.delivered);
  const ordered_json report = link_report(result, account);
  for (const auto& [key, cause] : {std::pair{"late", "late"},
                                   {"invalid", "invalid"},
                                   {"lost", "line"},
                                   {"reference_missing", "refers to what was lost"},
                                   {"skeleton_missing", "before the proportions"}}) {
    if (!report.is_object()) break;
    const std::int64_t count = std::min(missing, report.value(key, std::int64_t{0}));
    if (count > 0) causes[cause] = count;
    missing -= count;
  }
  if (missing > 0) causes[result.restarts > 0 ? "program_away" : "bus"] = missing;
  return causes;
}

double ms(const Histogram& histogram, double fraction) {
  return histogram.percentile(fraction).as_ms();
}

ordered_json hops_json(const DancerAccount& account) {
  ordered_json hops = ordered_json::array();
  for (std::size_t i = 0; i < kHopCount; ++i) {
    const Histogram& age = account.age_at_hop[i];
    if (age.count() > 0)
      hops.push_back({{"step", kHopNames[i]}, {"p50_ms", ms(age, 0.5)}, {"p99_ms", ms(age, 0.99)}});
  }
  return hops;
}

const Histogram& stage_age(const DancerAccount& account) {
  return account.age_at_hop[static_cast<std::size_t>(Hop::kStaged)];
}

void add_rhythm(const DemoRhythm& rhythm, ordered_json& document) {
  document["tempo_bpm"] = rhythm.tempo_bpm;
  for (const auto& [ending, figures] :
       {std::pair{"_raw", &rhythm.raw}, std::pair{"", &rhythm.shown}}) {
    const std::string of = ending;
    document["phase_mean_ms" + of] = figures->phase_mean_ms;
    document["phase_sd_ms" + of] = figures->phase_sd_ms;
    document["content_delay_ms" + of] = figures->content_delay_ms;
    document["mpjpe_mm" + of] = figures->error_mm;
    document["jerk_ratio" + of] = figures->jerk_ratio;
  }
}

void add_comparison(const DemoPictures& pictures, ordered_json& document) {
  for (const auto& [key, file] :
       {std::pair{"strip", &pictures.strip}, {"sway", &pictures.sway}, {"film", &pictures.film}})
    if (!file->empty()) document[key] = *file;
}

std::string ages_table(const DancerAccount& account, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t i = from; i < to; ++i) {
    const Histogram& age = account.age_at_hop[i];
    if (age.count() > 0)
      text += fmt::format("  {:<14} p50 {:>8.3f}   p99 {:>8.3f}\n", kHopNames[i], ms(age, 0.5),
                          ms(age, 0.99));
  }
  return text;
}

std::string rhythm_table(const DemoRhythm& rhythm) {
  std::string text =
      fmt::format("\n{:<28} {:>14} {:>10} {:>12} {:>14} {:>10}\n", "on the far stage",
                  "behind beat ms", "sd ms", "old ms", "off now mm", "jerk x");
  for (const auto& [name, figures] : {std::pair{"as poses come", &rhythm.raw},
                                      std::pair{"as the stage shows them", &rhythm.shown}})
    text += fmt::format("{:<28} {:>14.0f} {:>10.1f} {:>12.0f} {:>14.1f} {:>10.2f}\n", name,
                        figures->phase_mean_ms, figures->phase_sd_ms,
                        std::round(figures->content_delay_ms) + 0.0,  // never -0
                        figures->error_mm, figures->jerk_ratio);
  return text + "\n";
}

}  // namespace

std::string summary_json(const DemoResult& result) {
  ordered_json guests = ordered_json::array();
  for (const DancerAccount& account : result.accounts) {
    ordered_json lost = ordered_json::object();
    for (const auto& [cause, count] : losses(result, account)) lost[cause] = count;
    guests.push_back({{"id", std::string(account.guest.view())},
                      {"house", account.house == 0 ? "a" : "b"},
                      {"sent", account.sent},
                      {"delivered", account.delivered},
                      {"lost", lost},
                      {"age_p50_ms", ms(stage_age(account), 0.5)},
                      {"age_p99_ms", ms(stage_age(account), 0.99)},
                      {"own_stage_age_p50_ms", ms(account.age_at_home, 0.5)},
                      {"own_stage_age_p99_ms", ms(account.age_at_home, 0.99)},
                      {"staged", account.staged},
                      {"steps", hops_json(account)}});
  }
  ordered_json document{{"guests", guests},
                        {"pictures", result.pictures},
                        {"log", result.log},
                        {"seconds", result.seconds},
                        {"restarts", result.restarts}};
  const auto line = ordered_json::parse(result.line_report, nullptr, false);
  if (line.is_object()) document["line"] = line;
  if (result.rhythm) add_rhythm(*result.rhythm, document);
  add_comparison(result.comparison, document);
  return document.dump(2);
}

std::string summary_table(const DemoResult& result) {
  std::string text =
      fmt::format("\n{:<10} {:>5} {:>8} {:>10} {:>8}  {:>20}  {:>20}  {}\n", "dancer", "house",
                  "sent", "delivered", "%", "own stage p50/p99 ms", "far stage p50/p99 ms", "lost");
  for (const DancerAccount& account : result.accounts) {
    std::string lost;
    for (const auto& [cause, count] : losses(result, account))
      lost += fmt::format("{}{} {}", lost.empty() ? "" : ", ", cause, count);
    text += fmt::format(
        "{:<10} {:>5} {:>8} {:>10} {:>8.2f}  {:>20}  {:>20}  {}\n", account.guest.view(),
        account.house == 0 ? "A" : "B", account.sent, account.delivered,
        account.sent
            ? 100.0 * static_cast<double>(account.delivered) / static_cast<double>(account.sent)
            : 0.0,
        fmt::format("{:.2f} / {:.2f}", ms(account.age_at_home, 0.5), ms(account.age_at_home, 0.99)),
        fmt::format("{:.2f} / {:.2f}", ms(stage_age(account), 0.5), ms(stage_age(account), 0.99)),
        lost.empty() ? "-" : lost);
  }
  if (!result.accounts.empty()) {
    const DancerAccount& first = result.accounts.front();
    text += fmt::format("\n{}'s poses on the way, age in ms:\n", first.guest.view()) +
            ages_table(first, 0, kFirstOfStage) +
            "and those that the far stage shows, where prediction makes up for the way:\n" +
            ages_table(first, kFirstOfStage, kHopCount);
  }
  if (result.rhythm) text += rhythm_table(*result.rhythm);
  for (const std::string& picture : result.pictures) text += "picture " + picture + "\n";
  for (const std::string* file :
       {&result.comparison.strip, &result.comparison.sway, &result.comparison.film})
    if (!file->empty()) text += "picture " + *file + "\n";
  text += "log     " + result.log + "\n";
  return text;
}

}  // namespace dance
