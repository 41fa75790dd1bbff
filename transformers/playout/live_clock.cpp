#include "transformers/playout/live_clock.h"

namespace dance {
namespace {

// Beyond this the capture times are of another clock.
constexpr Duration kLongestTransit = Duration::s(2);
constexpr Duration kEarliest = Duration::ms(-100);
// A dance does not go back by less than this: then its time has jumped.
constexpr Duration kJumpBack = Duration::ms(500);

}  // namespace

void LiveClock::observe(const DancerTimeline& timeline, MotionSource& /*source*/) {
  if (least_transit_.add(timeline.transit(), timeline.arrived())) transit_ = timeline.transit();
  // A large change is another line or clock.
  const Duration least = least_transit_.value(), error = least - transit_;
  transit_ = error > kJumpBack || error < -kJumpBack ? least : transit_ + error / 64;
}

PlayoutClock::Choice LiveClock::choose(const DancerTimeline& /*timeline*/, MonoTime now,
                                       MonoTime shown) {
  const bool is_our_clock = transit_ >= kEarliest && transit_ <= kLongestTransit;
  const MonoTime wanted =
      now - (is_our_clock ? Duration::seconds(transit_.as_seconds() * (1.0 - lead_)) : transit_);
  // The delay that is not taken back may change: the dance stands still rather than go back.
  if (shown.is_set() && wanted < shown && wanted > shown - kJumpBack) return {shown, {}, true};
  return {wanted, {}, false};
}

}  // namespace dance
