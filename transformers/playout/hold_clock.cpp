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

void HoldClock::set(const FlowSetting& setting) {
  std::optional<Duration> window;
  if (!setting.is_on(FlowWord::kHold))
    window = Duration();
  else if (setting.hold_ms >= 0.0f)
    window = Duration::seconds(1e-3 * static_cast<double>(setting.hold_ms));
  if (window == window_) return;
  window_ = window;
  is_set_live_ = has_delay_;
}

void HoldClock::observe(const DancerTimeline& timeline, MotionSource& /*source*/) {
  transit_.add(timeline.transit(), timeline.arrived());
  play_out_.add(timeline.gap(), timeline.transit());
}

Duration HoldClock::target() const {
  const Duration least = transit_.value();
  return window_ ? least + *window_ : std::clamp(play_out_.needed(), least, least + kLongestWindow);
}

void HoldClock::follow_target(MonoTime now) {
  const Duration error = target() - delay_;
  // What a person changed is come to at the usual pace, however far it is.
  if (error <= kJump && error >= -kJump) is_set_live_ = false;
  if (!has_delay_ || (!is_set_live_ && (error > kJump || error < -kJump))) {
    delay_ = target();
    if (!has_delay_) begin_ = now;
    has_delay_ = true;
  } else {
    const double rate = !window_ && now - begin_ < kFirst ? kFirstSlewRate : kSlewRate;
    // The bound of a clock that jumped back would be negative.
    const Duration most =
        std::max(Duration(), Duration::seconds((now - delay_set_).as_seconds() * rate));
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
