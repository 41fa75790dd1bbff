#include "haptics/haptic_feed.h"

#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"

namespace dance {
namespace {

constexpr Duration kLooksAhead = Duration::ms(100);

}  // namespace

HapticFeed::HapticFeed(const GuestId& guest, const HapticMakerOptions& options, SignalPort& port,
                       Poller& poller)
    : guest_(guest),
      clock_id_(this_clock_id()),
      maker_id_(secure_random_u64()),
      port_(port),
      poller_(poller),
      maker_(options, maker_id_, clock_id_) {
  port_.subscribe<Touch>(From(Where::kStage, guest),
                         [this](const Channel&, const Touch& touch, MonoTime) {
                           if (touch.clock_id != clock_id_) {
                             ++of_other_clocks_;
                             return;
                           }
                           ++touches_;
                           const MonoTime now = mono_now();
                           if (makes(now)) maker_.feel(touch, now, *this);
                         });
  port_.subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
    if (beat.clock_id != clock_id_) {
      ++of_other_clocks_;
      return;
    }
    maker_.hear(beat);
    const MonoTime now = mono_now();
    if (makes(now)) maker_.look_ahead(now, *this);
  });
  port_.subscribe<Haptic>(
      From(Where::kCapture, guest),
      [this](const Channel&, const Haptic& haptic, MonoTime) { hear(haptic, mono_now()); });
  timer_ = poller_.add_timer(mono_now() + kLooksAhead, [this](MonoTime now) {
    if (makes(now)) maker_.look_ahead(now, *this);
    return now + kLooksAhead;
  });
}

HapticFeed::~HapticFeed() { poller_.remove_timer(timer_); }

void HapticFeed::on_haptic(const Haptic& haptic) {
  ++made_;
  // The device first.
  for (const auto& player : players_) player->take(haptic, mono_now());
  port_.publish(Where::kCapture, guest_, haptic);
}

void HapticFeed::hear(const Haptic& haptic, MonoTime now) {
  if (haptic.maker == maker_id_) return;
  if (haptic.clock_id != clock_id_) {
    ++of_other_clocks_;
    return;
  }
  // Of several the one with the smallest number makes; a replay has 0.
  if (haptic.maker > maker_id_) return;
  other_heard_ = now;
  ++heard_;
  for (const auto& player : players_) player->take(haptic, now);
}

void HapticFeed::set_on(bool is_on) {
  for (const auto& player : players_) player->set_on(is_on);
}

}  // namespace dance
