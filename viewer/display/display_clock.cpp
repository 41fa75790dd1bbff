#include "viewer/display/display_clock.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace dance {
namespace {

constexpr Duration kShortest = Duration::us(1'900);  // 500 Hz and a little
constexpr Duration kLongest = Duration::ms(60);
constexpr double kSameRate = 0.06;
constexpr double kMostSpread = 0.2;  // of a period
constexpr double kMostTurnsBetween = 600.0;

double percentile(std::span<double> values, double fraction) {
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

void DisplayClock::clear() {
  added_ = 0;
  is_locked_ = false;
  period_ = nominal_;
}

void DisplayClock::add(MonoTime returned) {
  if (added_ > 0 && returned <= at(0)) return;
  moments_[added_++ % kMoments] = returned;
  if (count() >= kFewest) estimate();
}

// A typical short step between moments; every second or third turn is hit where drawing is slow.
Duration DisplayClock::rough_period() const {
  std::array<double, kMoments> steps_s{};
  std::size_t n = 0;
  for (std::size_t i = 0; i + 1 < count(); ++i) {
    const Duration step = at(i) - at(i + 1);
    if (step >= kShortest && step <= kLongest) steps_s[n++] = step.as_seconds();
  }
  if (n < kFewest / 2) return nominal_;
  const double step_s = percentile({steps_s.data(), n}, 0.3);
  const double turns = std::round(step_s / nominal_.as_seconds());
  if (turns >= 1.0 && std::abs(step_s / turns / nominal_.as_seconds() - 1.0) < kSameRate)
    return Duration::seconds(step_s / turns);
  return Duration::seconds(step_s);
}

void DisplayClock::estimate() {
  const double rough_s = rough_period().as_seconds();
  const std::size_t n = count();
  // Turns between the newest moment and each: counted from step to step, so that the error of the
  // rough period does not add up.
  std::array<double, kMoments> turns{};
  for (std::size_t i = 1; i < n; ++i) {
    const double step = std::round((at(i - 1) - at(i)).as_seconds() / rough_s);
    turns[i] = turns[i - 1] + std::min(step, kMostTurnsBetween);
  }
  // The period: median of the slopes between moments half the memory apart.
  std::array<double, kMoments> values{};
  std::size_t slopes = 0;
  for (std::size_t i = 0; i + n / 2 < n; ++i) {
    const double between = turns[i + n / 2] - turns[i];
    if (between > 0.0) values[slopes++] = (at(i) - at(i + n / 2)).as_seconds() / between;
  }
  is_locked_ = false;
  if (slopes == 0) return;
  const double period_s = percentile({values.data(), slopes}, 0.5);
  if (period_s < kShortest.as_seconds() || period_s > kLongest.as_seconds()) return;
  for (std::size_t i = 0; i < n; ++i)
    values[i] = turns[i] * period_s - (at(0) - at(i)).as_seconds();
  const double early_s = percentile({values.data(), n}, 0.2);
  const double late_s = percentile({values.data(), n}, 0.8);
  period_ = Duration::seconds(period_s);
  phase_ = at(0) + Duration::seconds(early_s);
  spread_ = Duration::seconds(late_s - early_s);
  is_locked_ = late_s - early_s < kMostSpread * period_s;
}

MonoTime DisplayClock::next_after(MonoTime t) const {
  const std::int64_t period_ns = period_.count_ns();
  std::int64_t past_ns = (t - phase_).count_ns() % period_ns;
  if (past_ns < 0) past_ns += period_ns;
  return t + Duration::ns(period_ns - past_ns);
}

}  // namespace dance
