#include "core/net/clock_mapper.h"

#include <algorithm>
#include <cstdlib>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::int64_t kLongestRoundTrip_ns = 60'000'000'000;
// Crystals differ by up to 100 ppm; a second-old sample may be off by as much.
constexpr std::int64_t kDrift_ppm = 100;
// Until the first short round trips are in, the estimate is applied directly.
constexpr std::int64_t kSettle_ns = 2'000'000'000;
// Then the applied offset moves by at most this part of elapsed time: 1 ms a second is not visible
// in a dance and ten times the drift of crystals.
constexpr std::int64_t kSlew_ppm = 1000;
constexpr int kContradictionsToStep = 3;

}  // namespace

const ClockMapper::Estimate& ClockMapper::best(std::int64_t now_ns) const {
  DANCE_ASSERT(count_ > 0);
  const auto uncertainty_ns = [now_ns](const Estimate& e) {
    return e.round_trip_ns / 2 + (now_ns - e.at_ns) / 1'000'000 * kDrift_ppm;
  };
  return *std::min_element(
      ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(count_),
      [&](const Estimate& a, const Estimate& b) { return uncertainty_ns(a) < uncertainty_ns(b); });
}

// The true offset lies within half a round trip of each sample. Two samples whose ranges do not
// meet, drift allowed for, mean that a clock was set or stood still.
bool ClockMapper::contradicts(const Estimate& fresh) const {
  if (count_ == 0) return false;
  const Estimate& old = best(fresh.at_ns);
  const std::int64_t drift_ns = (fresh.at_ns - old.at_ns) / 1'000'000 * kDrift_ppm;
  const std::int64_t reach_ns =
      old.round_trip_ns / 2 + fresh.round_trip_ns / 2 + drift_ns + 1'000'000;
  return std::abs(fresh.offset_ns - old.offset_ns) > reach_ns;
}

bool ClockMapper::add(const Sample& s) {
  constexpr std::int64_t kFarthest_us = INT64_MAX / 4000;  // keeps the sums below within 64 bits
  if (std::abs(s.their_receive_us / 2) > kFarthest_us / 2 ||
      std::abs(s.their_send_us / 2) > kFarthest_us / 2)
    return false;
  const std::int64_t away_ns = (s.received - s.sent).count_ns();
  const std::int64_t held_ns = (s.their_send_us - s.their_receive_us) * 1000;
  const std::int64_t round_trip_ns = away_ns - held_ns;
  // Their stamps are whole microseconds, so a tiny negative is rounding.
  if (held_ns < 0 || round_trip_ns < -2000 || away_ns > kLongestRoundTrip_ns) return false;

  // offset = ((t1 − t0) + (t2 − t3)) / 2
  Estimate fresh;
  fresh.offset_ns = (s.their_receive_us * 1000 - s.sent.since_zero_ns()) / 2 +
                    (s.their_send_us * 1000 - s.received.since_zero_ns()) / 2;
  fresh.round_trip_ns = std::max<std::int64_t>(round_trip_ns, 0);
  fresh.at_ns = s.received.since_zero_ns();
  newest_round_trip_ns_ = fresh.round_trip_ns;

  if (contradicts(fresh)) {
    if (++contradictions_ < kContradictionsToStep) return true;
    count_ = next_ = 0;
    ++steps_;
  }
  contradictions_ = 0;
  const bool is_first = count_ == 0;
  ring_[next_] = fresh;
  next_ = (next_ + 1) % kWindow;
  count_ = std::min(count_ + 1, kWindow);
  if (is_first) settled_at_ns_ = fresh.at_ns + kSettle_ns;
  follow(best(fresh.at_ns).offset_ns, fresh.at_ns);
  return true;
}

void ClockMapper::follow(std::int64_t target_ns, std::int64_t now_ns) {
  const std::int64_t elapsed_ns = std::max<std::int64_t>(now_ns - followed_at_ns_, 0);
  followed_at_ns_ = now_ns;
  if (now_ns < settled_at_ns_) {
    offset_ns_ = target_ns;
    return;
  }
  const std::int64_t most_ns = elapsed_ns / 1'000'000 * kSlew_ppm;
  offset_ns_ += std::clamp(target_ns - offset_ns_, -most_ns, most_ns);
}

Duration ClockMapper::shortest_round_trip() const {
  std::int64_t shortest_ns = 0;
  for (std::size_t i = 0; i < count_; ++i)
    if (i == 0 || ring_[i].round_trip_ns < shortest_ns) shortest_ns = ring_[i].round_trip_ns;
  return Duration::ns(shortest_ns);
}

}  // namespace dance
