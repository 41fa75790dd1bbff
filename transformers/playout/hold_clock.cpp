#include "transformers/playout/hold_clock.h"

#include <algorithm>

namespace dance {
namespace {

// The stage's time runs at most this much faster or slower while the delay changes: not visible in
// a dance.
constexpr double kSlewRate = 0.05;
// While the line is not known yet, to be in time soon.
constexpr double kFirstSlewRate = 0.25;
constexpr Duration kFirst = Duration::s(2);
// A change so large is a new line or a new clock, not jitter: jump.
constexpr Duration kJump = Duration::ms(500);
// What a window finds by itself. Beyond, a dancer is better predicted than waited for.
constexpr Duration kLongestWindow = Duration::ms(250);

}  // namespace

void HoldClock::restart() {
  transit_.forget();
  has_delay_ = false;
  play_out_.forget();
}

void HoldClock::observe(const DancerTimeline& timeline, MotionSource& /*source*/) {
  transit_.add(timeline.transit(), timeline.arrived());
  if (!window_) play_out_.add(timeline.gap(), timeline.transit());
}

Duration HoldClock::target() const {
  const Duration least = transit_.value();
  return window_ ? least + *window_ : std::clamp(play_out_.needed(), least, least + kLongestWindow);
}

void HoldClock::follow_target(MonoTime now) {
  const Duration error = target() - delay_;
  if (!has_delay_ || error > kJump || error < -kJump) {
    delay_ = target();
    if (!has_delay_) begin_ = now;
    has_delay_ = true;
  } else {
    const double rate = !window_ && now - begin_ < kFirst ? kFirstSlewRate : kSlewRate;
    const Duration most = Duration::seconds((now - delay_set_).as_seconds() * rate);
    delay_ += std::clamp(error, -most, most);
  }
  delay_set_ = now;
}

PlayoutClock::Choice HoldClock::choose(const DancerTimeline& /*timeline*/, MonoTime now,
                                       MonoTime shown) {
  follow_target(now);
  const MonoTime wanted = now - delay_;
  // A delay that jumps up would have the dance go back: it stands still until its time comes again.
  if (shown.is_set() && wanted < shown) return {shown, {}, true};
  return {wanted, {}, false};
}

}  // namespace dance
