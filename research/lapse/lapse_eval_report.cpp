#include "research/lapse/lapse_eval_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace dance {

std::string lapse_table(const std::vector<LapseRow>& rows) {
  std::string text = fmt::format("{:>8}  {:<14}{:>9}{:>10}{:>8}{:>8}{:>8}{:>8}{:>9}{:>9}{:>8}\n",
                                 "lapse s", "", "error mm", "activity", "body", "start", "wraps",
                                 "return", "drift m", "after mm", "trials");
  for (const LapseRow& row : rows) {
    const LapseFigures& f = row.figures;
    text += fmt::format(
        "{:>8.2f}  {:<14}{:>9.1f}{:>10.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>8.2f}{:>9.2f}{:>9.1f}{:>8}\n",
        row.length.as_seconds(), row.subject, 1e3 * f.error_m, f.activity, f.body_activity,
        f.start_peak, f.wrap_peak, f.return_peak, f.root_drift_m, 1e3 * f.return_error_m, f.trials);
  }
  return text;
}

std::string lapse_json(const std::vector<LapseRow>& rows) {
  nlohmann::ordered_json report = nlohmann::ordered_json::array();
  for (const LapseRow& row : rows) {
    const LapseFigures& f = row.figures;
    report.push_back({{"lapse_s", row.length.as_seconds()},
                      {"shown", row.subject},
                      {"error_mm", 1e3 * f.error_m},
                      {"activity", f.activity},
                      {"body_activity", f.body_activity},
                      {"start_peak", f.start_peak},
                      {"wrap_peak", f.wrap_peak},
                      {"return_peak", f.return_peak},
                      {"root_drift_m", f.root_drift_m},
                      {"after_error_mm", 1e3 * f.return_error_m},
                      {"trials", f.trials}});
  }
  return report.dump(2) + "\n";
}

}  // namespace dance
