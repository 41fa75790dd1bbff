#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "research/style/stylize_eval.h"

namespace dance {
namespace {

nlohmann::ordered_json report_of(const StylizeEval& eval) {
  return {{"measured_gain", eval.measured_gain},
          {"mean_pose_shift_deg", eval.mean_pose_shift_deg},
          {"bone_length_error_mm", eval.bone_length_error_mm},
          {"other_zones_change", eval.other_zones_change_deg},
          {"phase_deg", eval.phase_deg},
          {"overall_gain", eval.overall_gain},
          {"periodic_share", eval.periodic_share},
          {"feet_moved_mm", eval.feet_moved_mm},
          {"feet_moved_p99_mm", eval.feet_moved_p99_mm},
          {"swing_gain", eval.swing_gain},
          {"swing_share", eval.swing_share},
          {"slide_mm_s", eval.slide_mm_s},
          {"danced_slide_mm_s", eval.danced_slide_mm_s},
          {"jerk_ratio", eval.jerk_ratio},
          {"identical", eval.is_identical},
          {"ns_per_pose", eval.ns_per_pose}};
}

void append_row(std::string& out, std::string_view name, const StylizeEval& eval) {
  fmt::format_to(
      std::back_inserter(out),
      "{:<24.24} {:>6.3f} {:>6.1f} {:>7.3f} {:>6.1f} {:>8.2f} {:>8.4f} {:>8.3f} {:>7.1f} "
      "{:>7.1f} {:>5.2f}\n",
      name, eval.measured_gain, eval.phase_deg, eval.overall_gain, 100.0 * eval.periodic_share,
      eval.mean_pose_shift_deg, eval.bone_length_error_mm, eval.other_zones_change_deg,
      eval.feet_moved_p99_mm, eval.feet_moved_mm, eval.jerk_ratio);
}

}  // namespace

std::string stylize_eval_json(const StylizeEval& all, std::span<const StylizeEval> takes,
                              const StylizeEvalOptions& options) {
  nlohmann::ordered_json json{{"zone", kZoneNames[index_of(options.zone)]},
                              {"gain", options.gain},
                              {"mix", options.mix},
                              {"with_music", !options.untagged}};
  json.update(report_of(all));
  json["takes"] = nlohmann::ordered_json::array();
  for (const StylizeEval& take : takes) {
    nlohmann::ordered_json row{{"name", take.name}};
    row.update(report_of(take));
    json["takes"].push_back(std::move(row));
  }
  return json.dump(2) + "\n";
}

std::string stylize_eval_table(const StylizeEval& all, std::span<const StylizeEval> takes,
                               const StylizeEvalOptions& options) {
  std::string out = fmt::format(
      "{} at gain {:g}, mix {:g}, the bar {}, after {:g} s; pose {}\n"
      "                           gain  phase overall  share     mean    bones   others    feet "
      "   feet  jerk\n"
      "take                              deg    gain      %      deg       mm      deg  p99 mm "
      " most mm ratio\n",
      kZoneNames[index_of(options.zone)], options.gain, options.mix,
      options.untagged ? "found in the motion" : "told by the music", options.warm_up_s,
      all.is_identical ? "bit for bit the same" : fmt::format("{:.1f} us", all.ns_per_pose / 1e3));
  for (const StylizeEval& take : takes) append_row(out, take.name, take);
  if (takes.size() > 1) append_row(out, "all", all);
  return out;
}

}  // namespace dance
