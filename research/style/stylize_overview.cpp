#include "research/style/stylize_overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace dance {
namespace {

constexpr std::array<double, 3> kOverviewMixes{0.0, kUsualMix, 1.0};
constexpr double kWithin = 0.06;

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

StylizeRow row_of(std::span<const StyleTake> takes, const StylizeEvalOptions& asked) {
  std::vector<StylizeEval> evals;
  for (const StyleTake& take : takes) evals.push_back(evaluate_stylize(take, asked));
  StylizeRow row{asked, sum_up(evals)};
  row.takes = evals.size();
  row.least_gain = row.most_gain = evals.front().measured_gain;
  std::vector<double> shifts_deg;
  for (const StylizeEval& eval : evals) {
    row.least_gain = std::min(row.least_gain, eval.measured_gain);
    row.most_gain = std::max(row.most_gain, eval.measured_gain);
    if (std::abs(eval.measured_gain - asked.gain) <= kWithin * asked.gain) ++row.takes_within;
    shifts_deg.push_back(eval.mean_pose_shift_deg);
  }
  row.median_mean_shift_deg = median_of(std::move(shifts_deg));
  return row;
}

}  // namespace

std::vector<StylizeRow> stylize_overview(std::span<const StyleTake> takes,
                                         const StylizeEvalOptions& asked) {
  std::vector<StylizeRow> rows;
  if (takes.empty()) return rows;
  StylizeEvalOptions options = asked;
  for (std::size_t z = 0; z < kBodyZones; ++z)
    for (const double mix : kOverviewMixes) {
      options.zone = static_cast<BodyZone>(z);
      options.mix = mix;
      rows.push_back(row_of(takes, options));
    }
  return rows;
}

std::string stylize_overview_table(std::span<const StylizeRow> rows) {
  if (rows.empty()) return {};
  const StylizeRow& first = rows.front();
  std::string out = fmt::format(
      "all zones at gain {:g}, {} takes, the bar {}, after {:g} s; gains are of all takes by "
      "energy\n"
      "                 gain    of takes     within   all    mean, deg    jerk   ankles others "
      "swing  slide danced\n"
      "zone       mix    all least   most      6 %    dev  median worst  ratio     mm    deg  "
      "gain   mm/s   mm/s\n",
      first.asked.gain, first.takes,
      first.asked.untagged ? "found in the motion" : "told by the music", first.asked.warm_up_s);
  for (const StylizeRow& row : rows) {
    fmt::format_to(
        std::back_inserter(out),
        "{:<10} {:>3g} {:>6.2f} {:>5.2f}  {:>5.2f} {:>4}/{:<4} {:>5.2f} {:>7.2f} {:>5.2f} "
        "{:>6.2f} {:>6.1f} {:>6.3f}",
        kZoneNames[index_of(row.asked.zone)], row.asked.mix, row.all.measured_gain, row.least_gain,
        row.most_gain, row.takes_within, row.takes, row.all.overall_gain, row.median_mean_shift_deg,
        row.all.mean_pose_shift_deg, row.all.jerk_ratio, row.all.feet_moved_mm,
        row.all.other_zones_change_deg);
    if (row.asked.zone == BodyZone::kLegs)
      fmt::format_to(std::back_inserter(out), " {:>5.2f} {:>6.1f} {:>6.1f}", row.all.swing_gain,
                     row.all.slide_mm_s, row.all.danced_slide_mm_s);
    out += '\n';
  }
  return out;
}

std::string stylize_overview_json(std::span<const StylizeRow> rows) {
  auto json = nlohmann::ordered_json::array();
  for (const StylizeRow& row : rows)
    json.push_back({{"zone", kZoneNames[index_of(row.asked.zone)]},
                    {"gain", row.asked.gain},
                    {"mix", row.asked.mix},
                    {"measured_gain", row.all.measured_gain},
                    {"least_gain", row.least_gain},
                    {"most_gain", row.most_gain},
                    {"takes", row.takes},
                    {"takes_within_6_percent", row.takes_within},
                    {"overall_gain", row.all.overall_gain},
                    {"mean_pose_shift_deg_median", row.median_mean_shift_deg},
                    {"mean_pose_shift_deg_worst", row.all.mean_pose_shift_deg},
                    {"jerk_ratio", row.all.jerk_ratio},
                    {"feet_moved_mm", row.all.feet_moved_mm},
                    {"other_zones_change", row.all.other_zones_change_deg},
                    {"swing_gain", row.all.swing_gain},
                    {"slide_mm_s", row.all.slide_mm_s},
                    {"danced_slide_mm_s", row.all.danced_slide_mm_s}});
  return json.dump(2) + "\n";
}

}  // namespace dance
