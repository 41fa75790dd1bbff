#include "bench/parts/ratio_reporter.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace dance {

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.aggregate_name != "median") continue;
    const std::string& name = run.run_name.function_name;
    const std::size_t slash = name.find('/');
    Row row{name.substr(0, slash),
            slash == std::string::npos ? "" : name.substr(slash + 1),
            run.GetAdjustedCPUTime(),
            {}};
    for (const auto& [counter, value] : run.counters) row.counters.emplace_back(counter, value);
    rows_.push_back(std::move(row));
  }
}

double RatioReporter::ratio_of(const Row& row) const {
  for (const Row& other : rows_)
    if (other.question == row.question && other.variant == "baseline") return row.ns / other.ns;
  return std::numeric_limits<double>::quiet_NaN();
}

void RatioReporter::Finalize() {
  std::ostream& out = GetOutputStream();
  out << fmt::format("{:<34} {:<26} {:>12} {:>12}\n", "question", "variant", "ns (median)",
                     "of baseline");
  for (const Row& row : rows_) {
    out << fmt::format("{:<34} {:<26} {:>12.1f} {:>11.2f}×", row.question, row.variant, row.ns,
                       ratio_of(row));
    for (const auto& [counter, value] : row.counters)
      out << fmt::format("  {} {:g}", counter, value);
    out << "\n";
  }
}

std::string RatioReporter::json() const {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Row& row : rows_) {
    nlohmann::ordered_json entry{{"question", row.question},
                                 {"variant", row.variant},
                                 {"ns", std::round(row.ns * 10.0) / 10.0}};
    if (const double ratio = ratio_of(row); std::isfinite(ratio))
      entry["ratio"] = std::round(ratio * 1000.0) / 1000.0;
    for (const auto& [counter, value] : row.counters) entry[counter] = value;
    rows.push_back(entry);
  }
  return rows.dump(2);
}

}  // namespace dance
