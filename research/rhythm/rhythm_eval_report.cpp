#include "research/rhythm/rhythm_eval_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/program/figures.h"

namespace dance {
namespace {

using Json = nlohmann::ordered_json;

std::string score_line(const std::string& name, const RhythmScore& s) {
  return fmt::format(
      "{:<34} {:>+8.1f} {:>7.1f} {:>6.0f}% {:>8.0f} {:>7.1f} {:>6.2f} {:>6.2f} {:>5.2f} to "
      "{:<5.2f} "
      "{:>5.1f} {:>7.0f}\n",
      name, s.phase_mean_ms, s.phase_sd_ms, 100.0 * s.phase_told, s.content_delay_ms, s.mpjpe_mm,
      s.jerk_ratio, s.foot_slide_ratio, s.least_rate, s.most_rate, s.jumps, s.jump_mm);
}

Json score_json(const RhythmScore& s) {
  return {{"phase_mean_ms", rounded(s.phase_mean_ms, 100.0)},
          {"phase_sd_ms", rounded(s.phase_sd_ms, 100.0)},
          {"phase_told", rounded(s.phase_told, 1000.0)},
          {"content_delay_ms", rounded(s.content_delay_ms, 10.0)},
          {"mpjpe_mm", rounded(s.mpjpe_mm, 100.0)},
          {"jerk_ratio", rounded(s.jerk_ratio, 1000.0)},
          {"foot_slide_ratio", rounded(s.foot_slide_ratio, 1000.0)},
          {"bone_length_error_mm", rounded(s.bone_length_error_mm, 1e4)},
          {"least_play_rate", rounded(s.least_rate, 1000.0)},
          {"most_play_rate", rounded(s.most_rate, 1000.0)},
          {"jumps", rounded(s.jumps, 100.0)},
          {"jump_mm", rounded(s.jump_mm, 10.0)}};
}

}  // namespace

std::string rhythm_eval_table(const std::vector<BeatDance>& dances,
                              const std::vector<RhythmRun>& runs, bool each) {
  std::string text = fmt::format(
      "{:<34} {:>8} {:>7} {:>7} {:>8} {:>7} {:>6} {:>6} {:>14} {:>5} {:>7}\n", "", "off beat",
      "sd ms", "told", "delay ms", "mm", "jerk", "feet", "play rate", "jumps", "jump mm");
  for (const RhythmRun& run : runs) {
    text += score_line(run.name, run.mean);
    if (!each) continue;
    for (std::size_t i = 0; i < dances.size(); ++i)
      text += score_line("  " + dances[i].name, run.dances[i]);
  }
  text +=
      "off beat: the wave of the four-count against the beat that the listener hears, ms, late is "
      "+;\n"
      "mm: against the dance at the same moment, hips removed; jerk, feet: against the dance "
      "itself.\n";
  return text;
}

std::string rhythm_eval_json(const std::vector<BeatDance>& dances,
                             const std::vector<RhythmRun>& runs) {
  const RhythmRun& ours = runs.back();
  const RhythmRun* hold = nullptr;
  for (const RhythmRun& run : runs)
    if (run.name == "hold") hold = &run;
  Json json;
  if (hold) {
    json["phase_mean_ms_before"] = rounded(hold->mean.phase_mean_ms, 100.0);
    json["phase_sd_ms_before"] = rounded(hold->mean.phase_sd_ms, 100.0);
  }
  json.update(score_json(ours.mean));
  json["phase_mean_ms_worst"] = rounded(ours.phase_mean_ms_worst, 100.0);
  json["phase_sd_ms_worst"] = rounded(ours.phase_sd_ms_worst, 100.0);
  for (const RhythmRun& run : runs)
    if (&run != &ours) json["baseline_" + run.name] = score_json(run.mean);
  for (std::size_t i = 0; i < dances.size(); ++i) {
    Json dance = {{"name", dances[i].name}};
    dance.update(score_json(ours.dances[i]));
    json["dances"].push_back(std::move(dance));
  }
  return json.dump(2) + "\n";
}

}  // namespace dance
