#include "producers/music/tap/tap_delay.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/median.h"

namespace dance {
namespace {

constexpr double kBounce_s = 0.25 * TapDelay::kPeriod_s;
constexpr double kMostTime_s = 1e6;
// The factor turns the median absolute deviation into the standard deviation of a normal
// distribution.
constexpr double kDeviation = 1.4826;

// Into half a period around 0.
double wrapped(double s) { return s - TapDelay::kPeriod_s * std::round(s / TapDelay::kPeriod_s); }

}  // namespace

void TapDelay::tap(double at_s) {
  if (!(std::abs(at_s) < kMostTime_s) || at_s - last_s_ < kBounce_s) return;
  last_s_ = at_s;
  if (count_ >= kFirst + kTaps) return;
  if (count_ >= kFirst) late_s_[count_ - kFirst] = wrapped(at_s);
  ++count_;
}

TapDelay::Result TapDelay::result() const {
  Result result;
  result.missing = kFirst + kTaps - count_;
  if (result.missing > 0) return result;
  // The tap that the others are nearest to: delays are on a circle, where a mean or a median of
  // numbers depends on where the circle is cut.
  const auto distance = [&](double from) {
    double sum = 0.0;
    for (const double late : late_s_) sum += std::abs(wrapped(late - from));
    return sum;
  };
  const double centre = *std::min_element(late_s_.begin(), late_s_.end(), [&](double a, double b) {
    return distance(a) < distance(b);
  });
  std::array<double, kTaps> off{};
  for (std::size_t i = 0; i < kTaps; ++i) off[i] = wrapped(late_s_[i] - centre);
  const double median = median_of(std::span<double>(off));
  for (double& each : off) each = std::abs(each - median);
  result.spread_s = kDeviation * median_of(std::span<double>(off));
  if (result.spread_s > kMostSpread_s) {
    result.state = State::kScattered;
    return result;
  }
  result.state = State::kFound;
  const double delay = wrapped(centre + median);
  result.delay_s = delay < kLeast_s ? delay + kPeriod_s : delay;
  return result;
}

}  // namespace dance
