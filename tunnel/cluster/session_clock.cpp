#include "tunnel/cluster/session_clock.h"

#include <algorithm>

namespace dance {
namespace {

constexpr std::int64_t kSlew_ppm = 500;
// Links measure the clock themselves, and take a jump for what it is.
constexpr Duration kJump = Duration::ms(20);

}  // namespace

void SessionClock::add(const ClockMapper::Sample& sample) {
  if (mapper_.add(sample)) samples_ = std::min(samples_ + 1, kEnough);
  advance(sample.received);
}

void SessionClock::advance(MonoTime now) {
  const Duration passed = advanced_.is_set() ? std::max(Duration(), now - advanced_) : Duration();
  advanced_ = now;
  if (!is_measured()) return;
  const std::int64_t off_ns = (mapper_.offset() - offset_).count_ns();
  if (off_ns > kJump.count_ns() || off_ns < -kJump.count_ns()) {
    offset_ = mapper_.offset();
    ++steps_;
    return;
  }
  // Turns may be much shorter than a millisecond, and some too short for a nanosecond of it.
  slew_left_ += passed.count_ns() * kSlew_ppm;
  const std::int64_t most_ns = slew_left_ / 1'000'000;
  slew_left_ %= 1'000'000;
  offset_ = offset_ + Duration::ns(std::clamp(off_ns, -most_ns, most_ns));
}

}  // namespace dance
