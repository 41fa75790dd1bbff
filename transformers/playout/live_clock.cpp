#include "transformers/playout/live_clock.h"

#include <algorithm>

namespace dance {
namespace {

// Beyond this the capture times are of another clock.
constexpr Duration kLongestTransit = Duration::s(2);
constexpr Duration kEarliest = Duration::ms(-100);
// A dance does not go back by less than this: then its time has jumped.
constexpr Duration kJumpBack = Duration::ms(500);
// Of a lead that is changed while dancing.
constexpr double kLeadPerSecond = 0.5;
constexpr double kMostPaceChange = 0.1;

}  // namespace

void LiveClock::observe(const DancerTimeline& timeline, MotionSource& /*source*/) {
  if (least_transit_.add(timeline.transit(), timeline.arrived())) transit_ = timeline.transit();
  // A large change is another line or clock.
  const Duration least = least_transit_.value(), error = least - transit_;
  transit_ = error > kJumpBack || error < -kJumpBack ? least : transit_ + error / 64;
}

void LiveClock::set(const FlowSetting& setting) {
  // Without predict nothing is taken back; a route that never had it keeps what it was made with.
  if (!setting.has_word(FlowWord::kPredict)) return;
  lead_.want(setting.is_on(FlowWord::kPredict) ? static_cast<double>(setting.lead) : 0.0);
}

PlayoutClock::Choice LiveClock::choose(const DancerTimeline& /*timeline*/, MonoTime now,
                                       MonoTime shown) {
  const bool is_our_clock = transit_ >= kEarliest && transit_ <= kLongestTransit;
  // The dance is not shown faster or slower by more than this while the lead changes.
  const double lead = lead_.advance(
      now, std::min(kLeadPerSecond, kMostPaceChange / std::max(1e-3, transit_.as_seconds())));
  const MonoTime wanted =
      now - (is_our_clock ? Duration::seconds(transit_.as_seconds() * (1.0 - lead)) : transit_);
  // The delay that is not taken back may change: the dance stands still rather than go back.
  if (shown.is_set() && wanted < shown && wanted > shown - kJumpBack) return {shown, {}, true};
  return {wanted, {}, false};
}

}  // namespace dance
