#include "voice/playout/time_stretch.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// The search is done on every fourth sample, and in steps of four.
constexpr std::size_t kStep = 4;
constexpr double kAlike = 0.75;
// Quieter sound, root mean square, may be cut anywhere.
constexpr double kQuiet = 0.003;

struct Match {
  std::size_t period = 0;
  double likeness = -1.0;
  double power = 0.0;
};

// How alike a[0 … n) and b[0 … n) are, -1 to 1.
Match likeness_of(const float* a, const float* b, std::size_t n) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < n; i += kStep) {
    const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  Match match{n, 0.0, (aa + bb) * static_cast<double>(kStep) / static_cast<double>(2 * n)};
  if (aa > 0.0 && bb > 0.0) match.likeness = ab / std::sqrt(aa * bb);
  return match;
}

bool may_use(const Match& match, bool must) {
  return match.period > 0 && (must || match.likeness > kAlike || match.power < kQuiet * kQuiet);
}

}  // namespace

std::size_t shorten(std::span<float> samples, bool must) {
  Match best;
  const std::size_t longest = std::min(kLongestPeriod, samples.size() / 2);
  for (std::size_t period = kShortestPeriod; period <= longest; period += kStep) {
    const Match match = likeness_of(samples.data(), samples.data() + period, period);
    if (match.likeness > best.likeness) best = match;
  }
  if (!may_use(best, must)) return 0;
  // Begins as the first period and ends as the second; what follows is in place.
  const std::size_t n = best.period;
  for (std::size_t i = 0; i < n; ++i) {
    const float w = static_cast<float>(i) / static_cast<float>(n);
    samples[n + i] = (1.0f - w) * samples[i] + w * samples[n + i];
  }
  return n;
}

std::size_t lengthen(std::span<const float> played, std::span<const float> next,
                     std::span<float> more, bool must) {
  Match best;
  const std::size_t longest = std::min({kLongestPeriod, played.size(), next.size(), more.size()});
  const float* end = played.data() + played.size();
  for (std::size_t period = kShortestPeriod; period <= longest; period += kStep) {
    const Match match = likeness_of(end - period, next.data(), period);
    if (match.likeness > best.likeness) best = match;
  }
  if (!may_use(best, must)) return 0;
  // Begins as what follows `played`, and ends as `played` does.
  const std::size_t n = best.period;
  for (std::size_t i = 0; i < n; ++i) {
    const float w = static_cast<float>(i) / static_cast<float>(n);
    more[i] = (1.0f - w) * next[i] + w * *(end - n + i);
  }
  return n;
}

}  // namespace dance
