#include "producers/music/beat_publisher.h"

#include <algorithm>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kPublishPeriod = Duration::ms(100);
// So long after a beat: at its own time a subscriber might still see it ahead.
constexpr Duration kAfterBeat = Duration::ms(1);
constexpr Duration kOtherTimeout = Duration::s(3);

bool is_same_beat(const Beat& a, const Beat& b) {
  // The bus keeps microseconds.
  return a.time.since_zero_us() == b.time.since_zero_us() && a.beat == b.beat &&
         a.beat_time.since_zero_us() == b.beat_time.since_zero_us() && a.clock_id == b.clock_id;
}

}  // namespace

BeatPublisher::BeatPublisher(SignalPort& bus, Poller& poller, Source source)
    : bus_(bus), source_(std::move(source)) {
  bus_.subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime now) {
    on_beat_heard(beat, now);
  });
  poller.add_timer(mono_now(), [this](MonoTime now) { return work(now); });
}

void BeatPublisher::publish(MonoTime now) {
  const auto beat = source_(now);
  if (!beat || !is_valid(*beat)) return;
  own_[published_++ % own_.size()] = *beat;
  bus_.publish(Channel::of_house(Signal::kBeat), *beat);
}

MonoTime BeatPublisher::work(MonoTime now) {
  publish(now);
  const MonoTime next = now + kPublishPeriod;
  if (published_ == 0) return next;
  const Beat& last = own_[(published_ - 1) % own_.size()];
  if (!last.playing || last.beat_time <= now) return next;
  return std::min(next, last.beat_time + kAfterBeat);
}

void BeatPublisher::on_beat_heard(const Beat& beat, MonoTime now) {
  const bool is_own = std::any_of(own_.begin(), own_.end(),
                                  [&](const Beat& own) { return is_same_beat(own, beat); });
  if (!is_own) other_heard_ = now;
}

bool BeatPublisher::has_other_publisher(MonoTime now) const {
  return other_heard_.is_set() && now - other_heard_ < kOtherTimeout;
}

}  // namespace dance
