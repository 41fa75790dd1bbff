#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/predict/predict_eval.h"

namespace dance {
namespace {

constexpr std::array<const char*, 3> kAcquaintedNames{"first 30 s", "30 s to 3 min", "after 3 min"};
constexpr std::array<const char*, 3> kAcquaintedKeys{"first_30_s", "until_3_min", "after_3_min"};

double best_baseline(const ForecastErrors& errors) {
  double best = errors[kForecastBaselines[0]];
  for (const std::size_t f : kForecastBaselines) best = std::min(best, errors[f]);
  return best;
}

double ratio(double a, double b) { return b > 0.0 ? a / b : 0.0; }

std::string row(const std::string& name, const std::vector<double>& values, int digits) {
  std::string line = fmt::format("  {:<30}", name);
  for (const double value : values) line += fmt::format(" {:>7.{}f}", value, digits);
  return line + "\n";
}

template <class Value>
std::vector<double> by_horizon(const std::vector<ForecastErrors>& errors, Value value) {
  std::vector<double> out;
  for (const ForecastErrors& e : errors) out.push_back(value(e));
  return out;
}

std::string words(const char* key) {
  std::string name = key;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

std::string predict_eval_table(const PredictEval& eval, const PredictEvalOptions& options) {
  std::string out = fmt::format(
      "{} frames, {} moments judged; sensor noise {:g} deg; {}; model {:08x}\n\n", eval.frames,
      eval.moments, options.noise_deg,
      options.fresh ? "every file a dancer never met"
                    : fmt::format("{} dancer{}, {} of whom the model knows", eval.dancers,
                                  eval.dancers == 1 ? "" : "s", eval.known_dancers),
      options.model->name);
  std::vector<double> horizons;
  for (const Duration h : options.horizons) horizons.push_back(h.as_ms());
  out += row("ms ahead", horizons, 0);
  for (std::size_t f = 0; f < kForecasts; ++f)
    out += row(words(kForecastNames[f]) + ", mm",
               by_horizon(eval.mean_m, [&](const auto& e) { return e[f] * 1e3; }), 1);
  out += row("ours of zero velocity",
             by_horizon(eval.mean_m, [](const auto& e) { return ratio(e[0], e[1]); }), 3);
  out +=
      row("ours of the best baseline",
          by_horizon(eval.mean_m, [](const auto& e) { return ratio(e[0], best_baseline(e)); }), 3);
  out += row("ours of the reference",
             by_horizon(eval.mean_m, [](const auto& e) { return ratio(e[0], e[4]); }), 3);
  std::vector<double> worst;
  for (const auto& w : eval.worst) worst.push_back(w.ratio);
  out += row("worst 10 s, of its baseline", worst, 3);
  out += "\n  of zero velocity, by how long the dancer was seen\n";
  for (std::size_t s = 0; s < eval.acquainted.size(); ++s)
    if (eval.acquainted[s].moments > 0)
      out += row(
          kAcquaintedNames[s],
          by_horizon(eval.acquainted[s].mean_m, [](const auto& e) { return ratio(e[0], e[1]); }),
          3);
  out += fmt::format("\n  {:.1f} us a frame, and {:.1f} us beside the pose path\n",
                     eval.ns_per_frame / 1e3, eval.ns_per_learning / 1e3);
  return out;
}

std::string predict_eval_json(const PredictEval& eval, const PredictEvalOptions& options) {
  nlohmann::ordered_json report;
  for (const Duration h : options.horizons) report["horizons_ms"].push_back(h.as_ms());
  const auto errors = [](const std::vector<ForecastErrors>& mean_m) {
    nlohmann::ordered_json table;
    for (std::size_t f = 0; f < kForecasts; ++f)
      for (const ForecastErrors& e : mean_m)
        table[kForecastNames[f]].push_back(rounded(e[f] * 1e3, 100.0));
    return table;
  };
  report["mpjpe_mm"] = errors(eval.mean_m);
  report["ns_per_frame"] = std::round(eval.ns_per_frame);
  report["ns_per_frame_learning"] = std::round(eval.ns_per_learning);
  for (const ForecastErrors& e : eval.mean_m) {
    report["ratio_to_zero_velocity"].push_back(rounded(ratio(e[0], e[1]), 1e4));
    report["ratio_to_best_baseline"].push_back(rounded(ratio(e[0], best_baseline(e)), 1e4));
  }
  for (const auto& worst : eval.worst)
    report["worst_10_s"].push_back({{"ratio_to_best_baseline", rounded(worst.ratio, 1e4)},
                                    {"take", worst.take},
                                    {"from_s", rounded(worst.from_s, 100.0)}});
  for (std::size_t s = 0; s < eval.acquainted.size(); ++s)
    report["by_time_with_dancer"][kAcquaintedKeys[s]] = {
        {"moments", eval.acquainted[s].moments}, {"mpjpe_mm", errors(eval.acquainted[s].mean_m)}};
  report["frames"] = eval.frames;
  report["moments"] = eval.moments;
  report["dancers"] = eval.dancers;
  report["dancers_known_to_the_model"] = eval.known_dancers;
  report["model"] = fmt::format("{:08x}", options.model->name);
  return report.dump(2) + "\n";
}

}  // namespace dance
