#include "haptics/haptic_player.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/deadline.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kSecond = Duration::s(1);

}  // namespace

HapticPlayer::HapticPlayer(std::unique_ptr<HapticOutput> output, HapticPlayerOptions options,
                           Poller& poller)
    : output_(std::move(output)),
      options_(options),
      poller_(poller),
      was_there_(output_->is_there()),
      has_been_there_(was_there_) {
  output_->set_limit(options_.limit);
  timer_ = poller_.add_timer(mono_now(), [this](MonoTime now) { return run(now); });
}

HapticPlayer::~HapticPlayer() {
  poller_.remove_timer(timer_);
  output_->stop();
}

MonoTime HapticPlayer::next_due() const {
  MonoTime due;
  for (std::size_t i = 0; i < waiting_count_; ++i) due = earlier(due, waiting_[i].due);
  return due;
}

MonoTime HapticPlayer::next_run() const {
  return earlier(next_due(), earlier(output_wants_, worked_ + kSecond));
}

void HapticPlayer::take(const Haptic& haptic, MonoTime now) {
  if (!options_.is_on) {
    ++counters_.muted;
    return;
  }
  if ((options_.bones & (1u << index_of(haptic.bone))) == 0) {
    ++counters_.elsewhere;
    return;
  }
  Order order{haptic.play_time - options_.latency - output_->latency(), haptic};
  order.haptic.amplitude = options_.strength * haptic.amplitude;
  if (now - order.due > kTooLate) {
    ++counters_.late;
    return;
  }
  // What cannot be early is played at once: its moment is when it came.
  if (order.due <= now) {
    order.due = now;
    play(order);
    poller_.set_deadline(timer_, next_run());
    return;
  }
  if (waiting_count_ == kMostWaiting) {
    ++counters_.full;
    return;
  }
  waiting_[waiting_count_++] = order;
  poller_.set_deadline(timer_, next_run());
}

void HapticPlayer::play(Order order) {
  // Here, as the limit may have been set while the order waited.
  if (order.haptic.amplitude > options_.limit) {
    order.haptic.amplitude = options_.limit;
    ++counters_.limited;
  }
  if (!(order.haptic.amplitude > 0.0f)) return;
  if (!output_->play(order.haptic, mono_now())) {
    ++counters_.refused;
    look_after_device();
    return;
  }
  lateness_.add(mono_now() - order.due);
  ++counters_.played;
  output_wants_ = earlier(output_wants_, mono_now());  // it may have something to end
}

MonoTime HapticPlayer::run(MonoTime now) {
  // What is due first is played first, also where several have become due meanwhile.
  for (;;) {
    Order* const first =
        std::min_element(waiting_.data(), waiting_.data() + waiting_count_,
                         [](const Order& a, const Order& b) { return a.due < b.due; });
    if (waiting_count_ == 0 || first->due > now) break;
    const Order order = *first;
    *first = waiting_[--waiting_count_];
    if (now - order.due > kTooLate)
      ++counters_.late;
    else
      play(order);
  }
  if ((output_wants_.is_set() && output_wants_ <= mono_now()) || now - worked_ >= kSecond) {
    worked_ = now;
    output_wants_ = output_->work(now);
    look_after_device();
  }
  return next_run();
}

void HapticPlayer::look_after_device() {
  const bool is_there = output_->is_there();
  if (is_there == was_there_) return;
  was_there_ = is_there;
  const char* const change = !is_there         ? " is lost: it is felt again when it is back"
                             : has_been_there_ ? " is there, and felt again"
                                               : " is there";
  has_been_there_ |= is_there;
  if (tell_) tell_(is_there, output_->name() + change);
}

void HapticPlayer::set_limit(float limit) {
  options_.limit = std::clamp(limit, 0.0f, 1.0f);
  output_->set_limit(options_.limit);
}

void HapticPlayer::set_on(bool is_on) {
  options_.is_on = is_on;
  if (is_on) return;
  waiting_count_ = 0;
  output_->stop();
}

std::string HapticPlayer::summary() const {
  std::string line = fmt::format("{}: {} played", output_->summary(), counters_.played);
  if (lateness_.count() > 0)
    line += fmt::format(", {:.2f} ms late (p50), {:.2f} ms (p99)",
                        lateness_.percentile(0.5).as_ms(), lateness_.percentile(0.99).as_ms());
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count > 0) line += fmt::format(", {} {}", count, what);
  };
  add(counters_.late, "left out as too late");
  add(counters_.full, "left out as too many waited");
  add(counters_.refused, "not taken by the device");
  add(counters_.limited, "made weaker, to the limit");
  add(counters_.muted, "left out while off");
  add(counters_.elsewhere, "of other bones");
  return line;
}

}  // namespace dance
