#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/predict/couple_eval.h"

namespace dance {
namespace {

struct Measure {
  const char* name;
  const char* key;
  double CouplePredictionErrors::*value;
};
constexpr std::array<Measure, 6> kMeasures{{
    {"body, mm", "mpjpe_mm", &CouplePredictionErrors::body_m},
    {"elbows and hands, mm", "arms_mm", &CouplePredictionErrors::arms_m},
    {"palms in the room, mm", "palms_world_mm", &CouplePredictionErrors::world_m},
    {"palms in a hold, mm", "held_mm", &CouplePredictionErrors::hold_m},
    {"the same, p95, mm", "held_p95_mm", &CouplePredictionErrors::hold_p95_m},
    {"palms' way a picture, mm", "palm_step_mm", &CouplePredictionErrors::step_m},
}};

template <class Value>
std::string row(const std::string& name, std::size_t count, int digits, Value value) {
  std::string line = fmt::format("  {:<34}", name);
  for (std::size_t h = 0; h < count; ++h) line += fmt::format(" {:>7.{}f}", value(h), digits);
  return line + "\n";
}

double share_of(double a, double b) { return b > 0.0 ? a / b : 0.0; }

}  // namespace

std::string couple_eval_table(const CoupleEval& eval, const CoupleEvalOptions& options) {
  const std::size_t count = options.horizons.size();
  std::string out = fmt::format(
      "{} moments judged; sensor noise {:g} deg; palms joined within {:g} m; model {:08x}\n"
      "a couple: {:.0f} % of the time beside the partner, {:.0f} % beside a dancer of another "
      "dance\n\n",
      eval.moments, options.noise_deg, options.join_m, options.model->name, 100.0 * eval.coupled[1],
      100.0 * eval.coupled[2]);
  out += row("ms ahead", count, 0, [&](std::size_t h) { return options.horizons[h].as_ms(); });
  for (const Measure& measure : kMeasures)
    for (std::size_t b = 0; b < kBesides; ++b)
      out += row(fmt::format("{:<25} {}", b == 0 ? measure.name : "", kBesideNames[b]), count, 1,
                 [&](std::size_t h) { return 1e3 * eval.errors[h][b].*measure.value; });
  const auto of_alone = [&](const char* name, double CouplePredictionErrors::*value,
                            std::size_t b) {
    return row(name, count, 3, [&](std::size_t h) {
      return share_of(eval.errors[h][b].*value, eval.errors[h][0].*value);
    });
  };
  out += "\n";
  out += of_alone("partner of alone: body", &CouplePredictionErrors::body_m, 1);
  out += of_alone("  elbows and hands", &CouplePredictionErrors::arms_m, 1);
  out += of_alone("  palms in the room", &CouplePredictionErrors::world_m, 1);
  out += of_alone("  palms in a hold", &CouplePredictionErrors::hold_m, 1);
  out += of_alone("stranger of alone: body", &CouplePredictionErrors::body_m, 2);
  out += of_alone("  palms in the room", &CouplePredictionErrors::world_m, 2);
  out += row("partner of the best dead reckoning", count, 3, [&](std::size_t h) {
    return share_of(eval.errors[h][1].body_m, eval.best_dead_reckoning_m[h]);
  });
  out += row("part of the palms in a hold", count, 2, [&](std::size_t h) { return eval.held[h]; });
  out += fmt::format("\n  {:.1f} us a frame for the partner\n", eval.ns_per_frame / 1e3);
  return out;
}

std::string couple_eval_json(const CoupleEval& eval, const CoupleEvalOptions& options) {
  nlohmann::ordered_json report;
  for (const Duration h : options.horizons) report["horizons_ms"].push_back(h.as_ms());
  for (std::size_t b = 0; b < kBesides; ++b)
    for (const Measure& measure : kMeasures)
      for (const auto& errors : eval.errors)
        report[kBesideNames[b]][measure.key].push_back(
            rounded(1e3 * errors[b].*measure.value, 100.0));
  for (const double error : eval.best_dead_reckoning_m)
    report["best_dead_reckoning_mm"].push_back(rounded(1e3 * error, 100.0));
  for (const double held : eval.held) report["held"].push_back(rounded(held, 1e4));
  report["coupled_with_partner"] = rounded(eval.coupled[1], 1e4);
  report["coupled_with_stranger"] = rounded(eval.coupled[2], 1e4);
  report["ns_per_frame"] = std::round(eval.ns_per_frame);
  report["moments"] = eval.moments;
  report["model"] = fmt::format("{:08x}", options.model->name);
  return report.dump(2) + "\n";
}

}  // namespace dance
