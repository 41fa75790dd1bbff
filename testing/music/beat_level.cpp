#include "testing/music/beat_level.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// Of half, of double, and of the tempo itself: nearer than this it is one of them.
constexpr double kNearLevel = 0.12;
// Between two beats: so far from the nearer one.
constexpr double kOffBeat_beats = 0.3;

bool is_near(double ratio, double level) { return std::abs(ratio / level - 1.0) < kNearLevel; }

}  // namespace

BeatLevel level_of_beats(std::span<const double> truth_s, std::span<const double> told_s,
                         double from_s, double to_s) {
  BeatLevel level;
  double all_s = 0.0;
  for (std::size_t k = 0; k + 1 < told_s.size(); ++k) {
    if (told_s[k] < from_s || told_s[k] >= to_s) continue;
    const auto after = std::upper_bound(truth_s.begin(), truth_s.end(), told_s[k]);
    if (after == truth_s.begin() || after == truth_s.end()) continue;
    const double true_s = *after - *std::prev(after);
    const double interval_s = told_s[k + 1] - told_s[k];
    const double place = (told_s[k] - *std::prev(after)) / true_s;
    const double weight_s = std::min(interval_s, 2.5 * true_s);  // a pause is no tempo
    all_s += weight_s;
    if (is_near(interval_s / true_s, 2.0)) level.half += weight_s;
    if (is_near(interval_s / true_s, 0.5)) level.twice += weight_s;
    if (is_near(interval_s / true_s, 1.0) && std::min(place, 1.0 - place) > kOffBeat_beats)
      level.off_beat += weight_s;
  }
  if (all_s > 0.0)
    for (double* share : {&level.half, &level.twice, &level.off_beat}) *share /= all_s;
  return level;
}

}  // namespace dance
