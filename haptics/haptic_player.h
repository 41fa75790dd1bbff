// HapticPlayer: hands what is to be felt to one device when it is due, so much earlier as the
// device is late, no stronger than allowed, and not at all while it is off. Says when the device is
// lost, and when it is there again.
//
// Units/frames: times of this house's clock.
// Ownership:    owns the device; room for kMostWaiting orders. Never allocates after construction.
// Threads:      none inside; runs in the poller's thread.
// Failure:      orders that come too late, do not fit, or that the device refuses are counted.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/base/histogram.h"
#include "core/net/poller.h"
#include "core/pose/pose.h"
#include "haptics/haptic_output.h"

namespace dance {

struct HapticPlayerOptions {
  float strength = 1.0f;  // times the amplitude, 0 to 2
  float limit = 1.0f;     // no amplitude above it, 0 to 1
  Duration latency;       // of the device, beside what it reports itself
  bool is_on = true;
  std::uint32_t bones = kAllBones;  // what it lets feel: a bit for each
};

class HapticPlayer {
 public:
  static constexpr std::size_t kMostWaiting = 64;
  // What is later than this is left out: it would be felt as something else.
  static constexpr Duration kTooLate = Duration::ms(120);

  struct Counters {
    std::uint64_t played = 0;
    std::uint64_t late = 0;       // left out
    std::uint64_t full = 0;       // left out: too many were waiting
    std::uint64_t refused = 0;    // by the device
    std::uint64_t limited = 0;    // were made weaker
    std::uint64_t muted = 0;      // while it was off
    std::uint64_t elsewhere = 0;  // of bones that are not its own
  };

  HapticPlayer(std::unique_ptr<HapticOutput> output, HapticPlayerOptions options, Poller& poller);
  ~HapticPlayer();
  HapticPlayer(const HapticPlayer&) = delete;
  HapticPlayer& operator=(const HapticPlayer&) = delete;

  // Must be valid.
  void take(const Haptic& haptic, MonoTime now);
  // Off: what is felt ends at once, and nothing is felt until it is on again.
  void set_on(bool is_on);
  bool is_on() const { return options_.is_on; }
  // 0 to 1; binds what waits, too.
  void set_limit(float limit);
  bool is_there() const { return output_->is_there(); }
  // One line for each change: the device is lost, or is there.
  using Tell = std::function<void(bool is_there, const std::string& line)>;
  void tell_changes(Tell tell) { tell_ = std::move(tell); }

  const Counters& counters() const { return counters_; }
  // From the moment an order was due to the moment at which the device had it.
  const Histogram& lateness() const { return lateness_; }
  std::string summary() const;

 private:
  struct Order {
    MonoTime due;
    Haptic haptic;
  };
  MonoTime run(MonoTime now);
  void play(Order order);
  void look_after_device();
  MonoTime next_due() const;
  // When the timer has something to do.
  MonoTime next_run() const;

  std::unique_ptr<HapticOutput> output_;
  HapticPlayerOptions options_;
  Poller& poller_;
  Poller::TimerId timer_ = 0;
  Tell tell_;
  bool was_there_ = true, has_been_there_ = true;
  std::array<Order, kMostWaiting> waiting_{};
  std::size_t waiting_count_ = 0;
  MonoTime output_wants_, worked_;
  Counters counters_;
  Histogram lateness_;
};

}  // namespace dance
