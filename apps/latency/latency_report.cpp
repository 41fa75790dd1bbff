#include "apps/latency/latency_report.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace dance {
namespace {

constexpr double kFractions[] = {0.50, 0.95, 0.99};

std::int64_t percentile_us(const Histogram& histogram, double fraction) {
  return histogram.percentile(fraction).count_us();
}

void append_row(std::string& out, const GuestJourney::Row& row) {
  const auto back = std::back_inserter(out);
  fmt::format_to(back, "  {:<15}", step_name(row.to));
  for (const double fraction : kFractions)
    fmt::format_to(back, "{:>9}", percentile_us(*row.took, fraction));
  fmt::format_to(back, "{:>9}", row.took->max().count_us());
  if (row.since_capture)
    fmt::format_to(back, "{:>11}{:>9}", percentile_us(*row.since_capture, 0.50),
                   percentile_us(*row.since_capture, 0.99));
  else
    fmt::format_to(back, "{:>11}{:>9}", "-", "-");
  fmt::format_to(back, "   {}", step_meaning(row.to));
  if (static_cast<int>(row.to) - static_cast<int>(row.from) > 1)
    fmt::format_to(back, " (since {})", step_name(row.from));
  out += '\n';
}

void append_notes(std::string& out, const GuestJourney& guest) {
  const auto back = std::back_inserter(out);
  std::string missing;
  for (std::size_t i = 1; i < kStepCount; ++i)
    if (!guest.has_passed(static_cast<Step>(i)))
      missing += (missing.empty() ? "" : ", ") + std::string(step_name(static_cast<Step>(i)));
  if (!missing.empty()) fmt::format_to(back, "  not passed: {}\n", missing);
  if (guest.has_passed(Step::kHeard) && guest.frames() == 0)
    out += "  no display runs on this bus: 'heard' is this program\n";
  if (guest.without_clock() > 0)
    fmt::format_to(back, "  {} poses say no clock: their stamps are not compared\n",
                   guest.without_clock());
  if (guest.of_another_clock() > 0)
    fmt::format_to(back,
                   "  {} poses carry another clock's stamps (a replayed log?): not compared with "
                   "this machine's\n",
                   guest.of_another_clock());
  if (guest.backwards() > 0)
    fmt::format_to(back,
                   "  {} times a step ended before it began and is left out: the stage shows a "
                   "prediction ahead of what has come (predict), or clocks were off\n",
                   guest.backwards());
}

nlohmann::ordered_json numbers(const Histogram& histogram) {
  return {{"p50_us", percentile_us(histogram, 0.50)},
          {"p95_us", percentile_us(histogram, 0.95)},
          {"p99_us", percentile_us(histogram, 0.99)},
          {"max_us", histogram.max().count_us()},
          {"count", histogram.count()}};
}

std::string snake_case(std::string_view name) {
  std::string text(name);
  for (char& c : text)
    if (c == ' ') c = '_';
  return text;
}

}  // namespace

std::string journey_table(const GuestJourney& guest) {
  std::string out;
  const auto rows = guest.rows();
  if (!rows.empty())
    fmt::format_to(std::back_inserter(out), "  {:<15}{:>9}{:>9}{:>9}{:>9}{:>11}{:>9}\n", "step",
                   "p50", "p95", "p99", "max", "all: p50", "p99");
  for (const auto& row : rows) append_row(out, row);
  append_notes(out, guest);
  return out;
}

std::string latency_table(const Journeys& journeys, const LatencyScope& scope) {
  std::string out;
  const auto back = std::back_inserter(out);
  for (const auto& guest : journeys.all()) {
    fmt::format_to(back, "{}: {} poses on the stage, {} shown, in {:.3g} s (µs)\n",
                   guest->guest().view(), guest->poses(), guest->frames(), scope.seconds);
    out += journey_table(*guest) + "\n";
  }
  if (journeys.refused() > 0)
    fmt::format_to(back, "{} poses of more guests than the table holds\n", journeys.refused());
  return out;
}

std::string latency_json(const Journeys& journeys, const LatencyScope& scope) {
  nlohmann::ordered_json guests = nlohmann::ordered_json::array();
  for (const auto& guest : journeys.all()) {
    nlohmann::ordered_json steps = nlohmann::ordered_json::array();
    for (const auto& row : guest->rows()) {
      nlohmann::ordered_json step{{"from", snake_case(step_name(row.from))},
                                  {"to", snake_case(step_name(row.to))}};
      step.update(numbers(*row.took));
      if (row.since_capture) step["since_capture"] = numbers(*row.since_capture);
      steps.push_back(step);
    }
    guests.push_back({{"id", guest->guest().view()},
                      {"poses", guest->poses()},
                      {"shown", guest->frames()},
                      {"without_clock", guest->without_clock()},
                      {"of_another_clock", guest->of_another_clock()},
                      {"backwards", guest->backwards()},
                      {"steps", steps}});
  }
  const nlohmann::ordered_json report{{"bus", scope.bus_url},
                                      {"seconds", scope.seconds},
                                      {"guests", guests},
                                      {"refused", journeys.refused()}};
  return report.dump(2) + "\n";
}

}  // namespace dance
