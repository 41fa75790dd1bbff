#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/program/figures.h"
#include "research/capture/several_eval.h"

namespace dance {
namespace {

double ratio_of(double one, double two) { return two > 0.0 ? one / two : 0.0; }

}  // namespace

std::string several_table(const std::vector<SeveralScore>& scores) {
  constexpr const char* kRow = "{:<28} {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>8} {:>8}\n";
  std::string text = fmt::format(fmt::runtime(kRow), "", "depth of", "", "depth of", "relative",
                                 "absolute", "hips'", "gain on", "on one") +
                     fmt::format(fmt::runtime(kRow), "", "hips mm", "p95", "joints", "mm", "mm",
                                 "step p99", "one", "told");
  for (const SeveralScore& s : scores) {
    text += fmt::format("{}, {:g} m ({} frames, {} of {} takes placed)\n", s.what.name,
                        s.what.distance_m, s.frames, s.placed, s.takes);
    for (std::size_t w = 0; w < kSeenByCount; ++w) {
      const DepthErrors& e = s.errors[w];
      const bool has_two = w >= 2;
      text += fmt::format("  {:<26} {:>8.1f} {:>8.1f} {:>8.1f} {:>9.1f} {:>9.1f} {:>8.1f}",
                          name_of(static_cast<SeenBy>(w)), e.hips_mm, e.hips_p95_mm, e.joints_mm,
                          e.relative_mm, e.absolute_mm, e.step_p99_mm);
      if (has_two)
        text += fmt::format(" {:>8.1f} {:>8.1f}", ratio_of(s.errors[0].hips_mm, e.hips_mm),
                            ratio_of(s.errors[1].hips_mm, e.hips_mm));
      text += "\n";
    }
    text += fmt::format(
        "  placed after {:.1f} s; off by {:.2f} deg, {:.0f} mm, {:.1f} ms; moved {} times{}; "
        "{:.0f} us "
        "more a picture\n",
        s.settled_s, s.turn_error_deg, s.place_error_mm, s.later_error_ms, s.moves,
        s.again_s >= 0.0 ? fmt::format(", placed again after {:.1f} s", s.again_s) : "",
        s.us_per_picture);
  }
  return text;
}

std::string several_json(const std::vector<SeveralScore>& scores) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SeveralScore& s : scores) {
    nlohmann::ordered_json ways;
    for (std::size_t w = 0; w < kSeenByCount; ++w) {
      const DepthErrors& e = s.errors[w];
      ways[name_of(static_cast<SeenBy>(w))] = {{"hips_depth_mm", rounded(e.hips_mm, 100.0)},
                                               {"hips_depth_p95_mm", rounded(e.hips_p95_mm, 100.0)},
                                               {"joints_depth_mm", rounded(e.joints_mm, 100.0)},
                                               {"relative_mm", rounded(e.relative_mm, 100.0)},
                                               {"absolute_mm", rounded(e.absolute_mm, 100.0)},
                                               {"hips_step_p99_mm", rounded(e.step_p99_mm, 100.0)}};
    }
    all.push_back({{"case", s.what.name},
                   {"distance_m", s.what.distance_m},
                   {"frames", s.frames},
                   {"takes", s.takes},
                   {"placed", s.placed},
                   {"errors", ways},
                   {"placed_after_s", rounded(s.settled_s, 100.0)},
                   {"turn_error_deg", rounded(s.turn_error_deg, 1000.0)},
                   {"place_error_mm", rounded(s.place_error_mm, 10.0)},
                   {"later_error_ms", rounded(s.later_error_ms, 100.0)},
                   {"moves", s.moves},
                   {"placed_again_after_s", rounded(s.again_s, 100.0)},
                   {"us_per_picture", rounded(s.us_per_picture, 1.0)}});
  }
  return all.dump(2) + "\n";
}

}  // namespace dance
