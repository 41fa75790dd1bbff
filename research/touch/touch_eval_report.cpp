#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "research/touch/touch_eval.h"

namespace dance {

std::string touch_eval_table(const TouchEval& eval) {
  std::string text;
  if (!eval.rows.empty()) {
    const HoldFigures& f = eval.rows.front().figures;
    text += fmt::format(
        "{:.1f} minutes; palms of the recording are within {:.0f} cm in {} pairs x pictures, {} "
        "times\n\n",
        f.seconds / 60.0, 100.0 * static_cast<double>(kTruth_m), f.true_frames, f.true_holds);
  }
  text += fmt::format("{:<20}{:<14}{:>9}{:>11}{:>11}{:>9}{:>12}{:>9}\n", "", "", "found",
                      "holds/min", "false/min", "far/min", "breaks/min", "apart");
  for (const TouchRow& row : eval.rows) {
    const HoldFigures& f = row.figures;
    text += fmt::format("{:<20}{:<14}{:>8.1f}%{:>11.1f}{:>11.2f}{:>9.2f}{:>12.1f}{:>8.1f}%\n",
                        row.stage, row.way, 100.0 * f.found(), f.per_minute(f.holds),
                        f.per_minute(f.false_holds), f.per_minute(f.far_holds),
                        f.per_minute(f.breaks), 100.0 * f.apart());
  }
  text += fmt::format("\n{:<20}{:>28}{:>28}{:>24}\n{:<20}{:>14}{:>14}{:>14}{:>14}{:>12}{:>12}\n",
                      "gap of held palms", "as shown, mm", "with hold-hands, mm", "p99 step, mm",
                      "", "p50", "p95", "p50", "p95", "shown", "reached");
  for (const GapRow& gap : eval.gaps)
    text += fmt::format("{:<20}{:>14.1f}{:>14.1f}{:>14.1f}{:>14.1f}{:>12.1f}{:>12.1f}\n", gap.stage,
                        gap.plain_p50_mm, gap.plain_p95_mm, gap.reached_p50_mm, gap.reached_p95_mm,
                        gap.step_plain_mm, gap.step_reached_mm);
  text += fmt::format("\nholds: {:.2f} us a pose; contacts: {:.2f} us a picture of the couple\n",
                      eval.us_a_pose, eval.us_a_picture);
  return text;
}

std::string touch_eval_json(const TouchEval& eval) {
  nlohmann::ordered_json report;
  for (const TouchRow& row : eval.rows) {
    const HoldFigures& f = row.figures;
    report["rows"].push_back({{"stage", row.stage},
                              {"way", row.way},
                              {"true_frames", f.true_frames},
                              {"found", f.found()},
                              {"holds_per_minute", f.per_minute(f.holds)},
                              {"false_holds_per_minute", f.per_minute(f.false_holds)},
                              {"far_holds_per_minute", f.per_minute(f.far_holds)},
                              {"breaks_per_minute", f.per_minute(f.breaks)},
                              {"held_frames", f.held_frames},
                              {"apart_frames", f.apart_frames},
                              {"seconds", f.seconds}});
  }
  for (const GapRow& gap : eval.gaps)
    report["gaps"].push_back({{"stage", gap.stage},
                              {"plain_p50_mm", gap.plain_p50_mm},
                              {"plain_p95_mm", gap.plain_p95_mm},
                              {"reached_p50_mm", gap.reached_p50_mm},
                              {"reached_p95_mm", gap.reached_p95_mm},
                              {"step_plain_mm", gap.step_plain_mm},
                              {"step_reached_mm", gap.step_reached_mm}});
  report["us_a_pose"] = eval.us_a_pose;
  report["us_a_picture"] = eval.us_a_picture;
  return report.dump(2) + "\n";
}

}  // namespace dance
