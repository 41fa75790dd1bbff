#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "research/stage/stage_eval.h"

namespace dance {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const StageMeasures& of) {
  return {{"hand_meetings", of.hand_meetings},
          {"hand_gap_mm_p95", or_null(of.hand_gap_mm_p95)},
          {"hand_gap_danced_mm_p95", or_null(of.hand_gap_danced_mm_p95)},
          {"hold_moments", of.hold_moments},
          {"hold_off_mm_p95", or_null(of.hold_off_mm_p95)},
          {"own_hands_off_mm_p95", or_null(of.own_hands_off_mm_p95)},
          {"standing_moments", of.standing_moments},
          {"foot_floor_mm_p95", or_null(of.foot_floor_mm_p95)},
          {"foot_floor_danced_mm_p95", or_null(of.foot_floor_danced_mm_p95)},
          {"foot_below_mm_max", of.foot_below_mm_max},
          {"foot_slide_mm_s", or_null(of.foot_slide_mm_s)},
          {"foot_slide_danced_mm_s", or_null(of.foot_slide_danced_mm_s)},
          {"wrist_twist_deg_max", of.wrist_twist_deg_max},
          {"elbow_twist_deg_max", of.elbow_twist_deg_max},
          {"joint_step_mm_max", of.joint_step_mm_max},
          {"joint_step_where", of.joint_step_where},
          {"joint_step_mm_p999", of.joint_step_mm_p999},
          {"joint_step_danced_mm_max", of.joint_step_danced_mm_max},
          {"stretch_percent_max", of.stretch_percent_max},
          {"stretched_share_percent", of.stretched_share_percent},
          {"us_per_figure", of.us_per_figure}};
}

std::string text_of(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{:.1f}", value.get<double>()) : value.dump();
}

}  // namespace

std::string stage_eval_json(const StageEval& eval) {
  Json json{{"dancers", eval.dancers}, {"avatars", eval.avatars}, {"frames", eval.frames}};
  json.update(json_of(eval.fitted));
  json["plain"] = json_of(eval.plain);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string stage_eval_table(const StageEval& eval) {
  std::string out;
  for (std::size_t d = 0; d < eval.dancers.size(); ++d)
    fmt::format_to(std::back_inserter(out), "{} as {}\n", eval.dancers[d], eval.avatars[d]);
  fmt::format_to(std::back_inserter(out), "{} frames\n\n{:<28}{:>24}{:>24}\n", eval.frames, "",
                 "fitted", "plain");
  const Json fitted = json_of(eval.fitted), plain = json_of(eval.plain);
  for (const auto& [key, value] : fitted.items())
    fmt::format_to(std::back_inserter(out), "{:<28}{:>24}{:>24}\n", key, text_of(value),
                   text_of(plain[key]));
  return out;
}

}  // namespace dance
