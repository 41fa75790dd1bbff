#include "producers/music/beat_teller.h"

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kTelling = Duration::ms(100);
// Behind a beat by so much, that a listener who turns at its time finds it passed.
constexpr Duration kRightAfter = Duration::ms(1);
constexpr Duration kAnotherIsGone = Duration::s(3);

bool is_same_beat(const Beat& a, const Beat& b) {
  // The bus keeps microseconds.
  return a.time.since_zero_us() == b.time.since_zero_us() && a.beat == b.beat &&
         a.beat_time.since_zero_us() == b.beat_time.since_zero_us() && a.clock_id == b.clock_id;
}

}  // namespace

BeatTeller::BeatTeller(Bus& bus, Poller& poller, Source source)
    : bus_(bus), source_(std::move(source)) {
  bus_.subscribe<Beat>(Where::kLocal,
                       [this](const Channel&, const Beat& beat, MonoTime now) { hear(beat, now); });
  poller.add_timer(mono_now(), [this](MonoTime now) { return work(now); });
}

void BeatTeller::tell(MonoTime now) {
  const auto beat = source_(now);
  if (!beat || !is_valid(*beat)) return;
  own_[told_++ % own_.size()] = *beat;
  bus_.publish(Channel::of_house(Signal::kBeat), *beat);
}

MonoTime BeatTeller::work(MonoTime now) {
  tell(now);
  const MonoTime next = now + kTelling;
  if (told_ == 0) return next;
  const Beat& last = own_[(told_ - 1) % own_.size()];
  if (!last.playing || last.beat_time <= now) return next;
  return std::min(next, last.beat_time + kRightAfter);
}

void BeatTeller::hear(const Beat& beat, MonoTime now) {
  const bool is_own = std::any_of(own_.begin(), own_.end(),
                                  [&](const Beat& own) { return is_same_beat(own, beat); });
  if (!is_own) heard_another_ = now;
}

bool BeatTeller::hears_another(MonoTime now) const {
  return heard_another_.is_set() && now - heard_another_ < kAnotherIsGone;
}

}  // namespace dance
