#include "haptics/haptic_feed.h"

#include <algorithm>

#include "core/net/mono_clock.h"
#include "core/net/secure_random.h"

namespace dance {
namespace {

constexpr Duration kLooksAhead = Duration::ms(100);

}  // namespace

HapticFeed::HapticFeed(const GuestId& guest, const HapticMakerOptions& options, SignalPort& port,
                       Poller& poller)
    : guest_(guest),
      options_(options),
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
                           maker_.take(touch, mono_now(), *this);
                         });
  port_.subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
    if (beat.clock_id != clock_id_) {
      ++of_other_clocks_;
      return;
    }
    maker_.hear(beat);
    maker_.look_ahead(mono_now(), *this);
  });
  port_.subscribe<Haptic>(
      From(Where::kCapture, guest),
      [this](const Channel&, const Haptic& haptic, MonoTime) { hear(haptic, mono_now()); });
  timer_ = poller_.add_timer(mono_now() + kLooksAhead, [this](MonoTime now) {
    maker_.look_ahead(now, *this);
    return now + kLooksAhead;
  });
}

HapticFeed::~HapticFeed() { poller_.remove_timer(timer_); }

bool HapticFeed::makes(HapticSource source, MonoTime now) {
  Other& other = others_[static_cast<std::size_t>(source)];
  if (!other.heard.is_set() || now - other.heard > kOtherMakes) return true;
  if (other.rested >= kMostRested) return true;
  ++other.rested;
  return false;
}

bool HapticFeed::wants(HapticSource source) const {
  switch (source) {
    case HapticSource::kTouch:
    case HapticSource::kHold:
      return options_.touch;
    case HapticSource::kLead:
      return options_.lead;
    case HapticSource::kBeat:
      return options_.beats != FeltBeats::kNone;
  }
  return false;
}

bool HapticFeed::is_own_choice(HapticSource source) const {
  return source != HapticSource::kBeat && !options_.from.empty();
}

bool HapticFeed::was_ordered(const Haptic& haptic) {
  Ordered& last = ordered_[static_cast<std::size_t>(haptic.source)][index_of(haptic.bone)];
  const Duration between = haptic.play_time - last.play;
  if (last.play.is_set() && last.maker != haptic.maker && between < kSame && between > -kSame) {
    ++twice_;
    return true;
  }
  last = {haptic.play_time, haptic.maker};
  return false;
}

void HapticFeed::on_haptic(const Haptic& haptic) {
  const MonoTime now = mono_now();
  if (!makes(haptic.source, now) || was_ordered(haptic)) return;
  ++made_;
  // The device first.
  for (const auto& player : players_) player->take(haptic, now);
  // Another feed of this guest is not to take the part for the whole.
  if (!is_own_choice(haptic.source)) port_.publish(Where::kCapture, guest_, haptic);
}

void HapticFeed::hear(const Haptic& haptic, MonoTime now) {
  if (haptic.maker == maker_id_) return;
  if (haptic.clock_id != clock_id_) {
    ++of_other_clocks_;
    return;
  }
  if (haptic.maker != 0 && is_own_choice(haptic.source)) return;
  // Of several the one with the smallest number makes; a replay has 0, and makes all kinds.
  if (haptic.maker > maker_id_) return;
  for (std::size_t source = 0; source < kHapticSources; ++source)
    if (haptic.maker == 0 || source == static_cast<std::size_t>(haptic.source))
      others_[source] = {now, 0};
  if (!wants(haptic.source)) return;
  ++heard_;
  if (was_ordered(haptic)) return;
  for (const auto& player : players_) player->take(haptic, now);
}

void HapticFeed::set_on(bool is_on) {
  for (const auto& player : players_) player->set_on(is_on);
}

bool HapticFeed::is_on() const {
  return std::any_of(players_.begin(), players_.end(), [](const auto& p) { return p->is_on(); });
}

void HapticFeed::set_limit(float limit) {
  for (const auto& player : players_) player->set_limit(limit);
}

}  // namespace dance
