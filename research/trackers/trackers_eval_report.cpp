#include <fmt/format.h>

#include "research/trackers/trackers_eval.h"

namespace dance {

std::string trackers_eval_table(const std::vector<TrackerTrial>& trials,
                                const std::vector<TrackerScore>& scores) {
  std::string out = fmt::format(
      "{:>6}  {:<9}  {:<8} {:>7} {:>7} {:>6} {:>6} {:>7} {:>7} {:>6} {:>7} {:>6} {:>7} {:>6}\n",
      "points", "guide", "start", "joints", "of hips", "turns", "hips", "slide", "jerk", "lost",
      "step", "us", "us", "body");
  out += fmt::format(
      "{:>6}  {:<9}  {:<8} {:>7} {:>7} {:>6} {:>6} {:>7} {:>7} {:>6} {:>7} {:>6} {:>7} {:>6}\n", "",
      "", "", "mm", "mm", "deg", "mm", "mm/s", "x", "mm", "mm", "median", "p99", "mm");
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const TrackerScore& s = scores[i];
    const char* guide = trials[i].guide == TrackerGuide::kGeometric ? "geometric"
                        : trials[i].guide == TrackerGuide::kLearned ? "learned"
                                                                    : "default";
    out += fmt::format(
        "{:>6}  {:<9}  {:<8} {:>7.1f} {:>7.1f} {:>6.2f} {:>6.1f} {:>7.1f} {:>7.2f} {:>6.1f} "
        "{:>7.1f} {:>6.1f} {:>7.1f} {:>6.1f}\n",
        trials[i].points, guide, trials[i].start == TrackerStart::kTPose ? "T-pose" : "dancing",
        1e3 * s.joints_m, 1e3 * s.body_m, s.turns_deg, 1e3 * s.hips_m, 1e3 * s.slide_m_s,
        s.jerk_ratio, 1e3 * s.lost_m, 1e3 * s.lost_jump_m, s.median_us, s.p99_us,
        1e3 * s.proportions_m);
  }
  if (!scores.empty())
    out += fmt::format(
        "\n{} frames each; true feet that stand slide by {:.1f} mm/s; body: what true turns on the "
        "body that was\n"
        "found are off by; calibration: height off by {:.1f} mm, arms by {:.1f} %\n",
        scores[0].frames, 1e3 * scores[0].true_slide_m_s, 1e3 * scores[0].height_error_m,
        100.0 * scores[0].arm_error);
  return out;
}

}  // namespace dance
