#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "research/capture/stereo_eval.h"

namespace dance {

const char* name_of(DepthWay way) {
  switch (way) {
    case DepthWay::kStereo:
      return "two eyes";
    case DepthWay::kOneEye:
      return "one eye";
    case DepthWay::kOneEyeKnownSize:
      return "one eye, size known";
    case DepthWay::kTwoNetworks:
      return "two networks";
  }
  return "";
}

std::string stereo_eval_table(const std::vector<StereoEval>& evals) {
  std::string out = "depth of the hips, error in mm; size of the dancer, error in %\n\n";
  for (const StereoEval& eval : evals) {
    out += fmt::format("{}: {} m, pattern {:.0f} grey levels, landmarks {} px\n", eval.what.name,
                       eval.what.distance_m, eval.what.contrast, eval.what.image_px);
    out += fmt::format("  {:<21}{:>8}{:>8}{:>8}{:>9}\n", "", "mean", "p95", "bias", "size");
    for (std::size_t way = 0; way < kDepthWayCount; ++way) {
      const ErrorSummary& error = eval.errors[way];
      out += fmt::format("  {:<21}{:>8.1f}{:>8.1f}{:>8.1f}{:>8.2f}%\n",
                         name_of(static_cast<DepthWay>(way)), error.mean_mm, error.p95_mm,
                         error.bias_mm, error.scale_mean_percent);
    }
    out += fmt::format(
        "  {} of {} frames with a depth, {:.1f} places of the body each; {:.0f} % within two of "
        "their "
        "spreads; {:.0f} us a frame\n\n",
        eval.hinted, eval.frames, eval.joints_mean, 100.0 * eval.within_two_spreads,
        eval.us_per_frame);
  }
  return out;
}

std::string stereo_eval_json(const std::vector<StereoEval>& evals) {
  nlohmann::json cases = nlohmann::json::array();
  for (const StereoEval& eval : evals) {
    nlohmann::json one{{"name", eval.what.name},
                       {"distance_m", eval.what.distance_m},
                       {"contrast", eval.what.contrast},
                       {"landmark_error_px", eval.what.image_px},
                       {"frames", eval.frames},
                       {"hinted", eval.hinted},
                       {"joints_mean", eval.joints_mean},
                       {"within_two_spreads", eval.within_two_spreads},
                       {"row_offset_px", eval.row_offset_px},
                       {"us_per_frame", eval.us_per_frame}};
    constexpr std::array<const char*, kDepthWayCount> kKeys{"stereo", "monocular",
                                                            "monocular_size_known", "two_networks"};
    for (std::size_t way = 0; way < kDepthWayCount; ++way) {
      const ErrorSummary& error = eval.errors[way];
      one[kKeys[way]] = {{"root_mean_mm", error.mean_mm},
                         {"root_p95_mm", error.p95_mm},
                         {"root_bias_mm", error.bias_mm},
                         {"scale_mean_percent", error.scale_mean_percent}};
    }
    cases.push_back(one);
  }
  return nlohmann::json{{"cases", cases}}.dump(2) + "\n";
}

}  // namespace dance
