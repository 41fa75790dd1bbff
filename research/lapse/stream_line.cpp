#include "research/lapse/stream_line.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

// In units of its mean.
double draw_jitter(StreamLine::Jitter shape, Random& random) {
  const auto exponential = [&] { return -std::log(1.0 - random.uniform()); };
  // The mean size of a standard normal deviation is sqrt(2/pi).
  constexpr double kMeanSize = 0.7978845608028654;
  switch (shape) {
    case StreamLine::Jitter::kExponential:
      return exponential();
    case StreamLine::Jitter::kGamma: {
      const double first = exponential();
      return 0.5 * (first + exponential());
    }
    case StreamLine::Jitter::kNormal:
      return std::abs(random.normal()) / kMeanSize;
  }
  return 0.0;
}

}  // namespace

std::vector<StreamArrival> arrivals_over(const StreamLine& line, std::span<const Pose> poses) {
  Random random(line.seed);
  std::vector<StreamArrival> arrivals;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i % std::max<std::size_t>(1, line.every) != 0) continue;
    // Drawn for every pose, so that loss and jitter do not depend on each other.
    const bool is_lost = 100.0 * random.uniform() < line.loss_percent;
    const double late = draw_jitter(line.shape, random);
    MonoTime at =
        poses[i].capture_time + line.delay + Duration::seconds(line.jitter.as_seconds() * late);
    bool is_swallowed = false;
    for (const StreamLine::Stall& stall : line.stalls) {
      const MonoTime end = stall.begin + stall.length;
      if (at < stall.begin || at >= end) continue;
      is_swallowed = is_swallowed || stall.loses;
      at = end;
    }
    if (!is_lost && !is_swallowed) arrivals.push_back({at, i});
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const StreamArrival& a, const StreamArrival& b) { return a.at < b.at; });
  return arrivals;
}

}  // namespace dance
