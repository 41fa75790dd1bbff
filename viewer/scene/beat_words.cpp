#include "viewer/scene/beat_words.h"

#include <fmt/format.h>

#include <cmath>

namespace dance {
namespace {

constexpr double kNow_ms = 10.0;  // not visible
// Ages are means over some seconds, each of its own poses.
constexpr double kNewer_ms = 5.0;

}  // namespace

std::string beat_words(double behind_ms) {
  const double off_ms = std::round(behind_ms);
  if (off_ms == 0.0) return "on the beat";
  return fmt::format("{:.0f} ms {} the beat", std::abs(off_ms), off_ms < 0.0 ? "before" : "behind");
}

std::string prediction_words(double age_ms) {
  return age_ms > kNow_ms ? fmt::format("predicted as of {:.0f} ms ago", age_ms)
                          : "predicted as of now";
}

bool is_predicted(double shown_age_ms, double come_age_ms) {
  return shown_age_ms < come_age_ms - kNewer_ms;
}

}  // namespace dance
