#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/display/display_eval.h"

namespace dance {
namespace {

template <class Value>
std::vector<double> by_horizon(const DisplayEval& eval, Value value) {
  std::vector<double> values;
  for (const DisplayErrors& errors : eval.errors) values.push_back(rounded(value(errors), 1e3));
  return values;
}

std::string row(const char* name, const std::vector<double>& values, int digits) {
  std::string line = fmt::format("  {:<44}", name);
  for (const double value : values) line += fmt::format(" {:>8.{}f}", value, digits);
  return line + "\n";
}

}  // namespace

std::string display_eval_table(const DisplayEval& eval, const DisplayEvalOptions& options) {
  std::string out = fmt::format("{} moments judged, poses at {:g} Hz, sensor noise {:g} deg\n\n",
                                eval.moments, options.hz, options.noise_deg);
  out += row("ms from the pose to its light", options.horizons_ms, 0);
  out += row("shown as it came, mean error, mm",
             by_horizon(eval, [](const auto& e) { return e.held_mean_mm; }), 2);
  out += row("extrapolated", by_horizon(eval, [](const auto& e) { return e.ours_mean_mm; }), 2);
  out += row("shown as it came, 95th percentile, mm",
             by_horizon(eval, [](const auto& e) { return e.held_p95_mm; }), 2);
  out += row("extrapolated", by_horizon(eval, [](const auto& e) { return e.ours_p95_mm; }), 2);
  struct Part {
    const char* name;
    PartErrors DisplayErrors::*errors;
  };
  for (const Part& part :
       {Part{"head", &DisplayErrors::head}, Part{"hands", &DisplayErrors::hands}}) {
    const auto of = [&](double PartErrors::*value) {
      return by_horizon(eval, [&](const auto& e) { return (e.*(part.errors)).*value; });
    };
    out +=
        row(fmt::format("{}, as it came, mm", part.name).c_str(), of(&PartErrors::held_mean_mm), 2);
    out += row("extrapolated", of(&PartErrors::ours_mean_mm), 2);
    out += row(fmt::format("{}, as it came, degrees", part.name).c_str(),
               of(&PartErrors::held_mean_deg), 2);
    out += row("extrapolated", of(&PartErrors::ours_mean_deg), 2);
  }
  out += row("feet below the floor by at most, mm",
             by_horizon(eval, [](const auto& e) { return e.below_floor_mm; }), 2);
  return out + fmt::format("\n  {:.1f} us a pose\n", 1e-3 * eval.ns_per_pose);
}

std::string display_eval_json(const DisplayEval& eval, const DisplayEvalOptions& options) {
  nlohmann::json json;
  json["moments"] = eval.moments;
  json["hz"] = options.hz;
  json["noise_deg"] = options.noise_deg;
  json["horizons_ms"] = options.horizons_ms;
  json["held_mm"] = {{"mean", by_horizon(eval, [](const auto& e) { return e.held_mean_mm; })},
                     {"p95", by_horizon(eval, [](const auto& e) { return e.held_p95_mm; })}};
  json["extrapolated_mm"] = {
      {"mean", by_horizon(eval, [](const auto& e) { return e.ours_mean_mm; })},
      {"p95", by_horizon(eval, [](const auto& e) { return e.ours_p95_mm; })}};
  for (const auto& [name, part] :
       {std::pair{"head", &DisplayErrors::head}, std::pair{"hands", &DisplayErrors::hands}}) {
    const auto of = [&, part = part](double PartErrors::*value) {
      return by_horizon(eval, [&](const auto& e) { return (e.*part).*value; });
    };
    json[name] = {{"held_mm", of(&PartErrors::held_mean_mm)},
                  {"extrapolated_mm", of(&PartErrors::ours_mean_mm)},
                  {"held_deg", of(&PartErrors::held_mean_deg)},
                  {"extrapolated_deg", of(&PartErrors::ours_mean_deg)}};
  }
  json["below_floor_mm"] = by_horizon(eval, [](const auto& e) { return e.below_floor_mm; });
  json["ns_per_pose"] = rounded(eval.ns_per_pose, 1.0);
  return json.dump() + "\n";
}

}  // namespace dance
