// Maps the stamps of a sender that cannot be asked for its time, from when its datagrams arrive:
// delay only ever adds, so the datagram that took least gives the best offset. A datagram that
// arrives later than that was captured earlier. If all come later for a whole second, it is no
// delay: the sender's clock fell back, as that of a game engine does that caps the length of a
// frame.
//
// Units/frames: theirs are plain microseconds of the sender's clock; ours is MonoTime. What is left
//               is the shortest delay itself, which no one-way stream can tell.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      a stamp that jumps by more than a second resets the map; one that falls back by
//               less is followed after a second. steps() counts both. While a sender's clock stands
//               still, or ticks so seldom that a quarter of the stamps repeat, stamps give no
//               capture times: the times of arrival are used, and is_unusable() is true.
// Source:       minimum filter as in RFC 5905 (NTP), clock filter algorithm, over one direction.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class OneWayClock {
 public:
  // When the sender stamped what arrived at `received`; never later than that.
  MonoTime to_ours(std::int64_t their_us, MonoTime received) {
    constexpr std::int64_t kFarthest_us = INT64_MAX / 4000;  // keeps the sums within 64 bits
    if (their_us > kFarthest_us || their_us < -kFarthest_us) return received;
    const std::int64_t now_ns = received.since_zero_ns();
    note_stamp(their_us, now_ns);
    if (is_unusable_) return received;
    const std::int64_t offset_ns = now_ns - their_us * 1000;
    const std::int64_t apart_ns = offset_ns - applied_ns_;
    if (!has_begun_ || apart_ns > kStep_ns || apart_ns < -kStep_ns) {
      if (has_begun_) ++steps_;
      has_begun_ = true;
      begin(offset_ns, now_ns);
      return received;
    }
    if (fell_back(offset_ns, now_ns)) {
      ++steps_;
      begin(late_least_ns_, now_ns);
      return MonoTime::from_ns(their_us * 1000 + applied_ns_);
    }
    if (now_ns - window_began_ns_ > kWindow_ns) {
      earlier_ns_ = least_ns_;
      least_ns_ = offset_ns;
      window_began_ns_ = now_ns;
    }
    least_ns_ = std::min(least_ns_, offset_ns);
    // Up slowly, so that captures keep their distances; down at once, as nothing arrives before it
    // was sent.
    const std::int64_t most_ns = std::max<std::int64_t>(now_ns - followed_ns_, 0) / kSlowest;
    followed_ns_ = now_ns;
    applied_ns_ = std::min(std::min(least_ns_, earlier_ns_), applied_ns_ + most_ns);
    return MonoTime::from_ns(their_us * 1000 + applied_ns_);
  }
  // For another sender.
  void begin_anew() {
    has_begun_ = has_stamp_ = is_unusable_ = false;
    repeats_ = 0;
  }
  std::uint64_t steps() const { return steps_; }
  bool is_unusable() const { return is_unusable_; }

 private:
  static constexpr std::int64_t kStep_ns = 1'000'000'000;
  static constexpr std::int64_t kWindow_ns = 10'000'000'000;
  static constexpr std::int64_t kSlowest = 1000;  // 1 ms a second: ten times the drift of crystals
  static constexpr std::int64_t kLate_ns = 30'000'000;
  static constexpr std::int64_t kLateFor_ns = 1'000'000'000;
  static constexpr int kLateDatagrams = 16;  // of a slow sender a few may all have been delayed

  // A copy of a datagram arrives at once; the same stamp later is of another frame.
  static constexpr std::int64_t kCopy_ns = 4'000'000;
  // A repeated stamp counts as much as kRepeat new ones. The second of a row makes the clock
  // unusable; at most kMostRepeats new ones without a repeat make it usable again.
  static constexpr int kRepeat = 3;
  static constexpr int kMostRepeats = 30;

  void note_stamp(std::int64_t their_us, std::int64_t now_ns) {
    if (has_stamp_ && their_us == stamp_us_) {
      if (now_ns - stamp_began_ns_ >= kCopy_ns)
        repeats_ = std::min(repeats_ + kRepeat, kMostRepeats);
    } else {
      has_stamp_ = true;
      stamp_us_ = their_us;
      stamp_began_ns_ = now_ns;
      repeats_ = std::max(repeats_ - 1, 0);
    }
    if (!is_unusable_ && repeats_ >= 2 * kRepeat) {
      is_unusable_ = true;
      has_begun_ = false;
    } else if (is_unusable_ && repeats_ == 0) {
      is_unusable_ = false;
    }
  }
  void begin(std::int64_t offset_ns, std::int64_t now_ns) {
    applied_ns_ = least_ns_ = earlier_ns_ = offset_ns;
    window_began_ns_ = followed_ns_ = now_ns;
    late_datagrams_ = 0;
  }
  // Whether all that came for so long came late, by late_least_ns_ - applied_ns_ or more.
  bool fell_back(std::int64_t offset_ns, std::int64_t now_ns) {
    if (offset_ns - applied_ns_ <= kLate_ns) {
      late_datagrams_ = 0;
      return false;
    }
    if (late_datagrams_ == 0) {
      late_began_ns_ = now_ns;
      late_least_ns_ = offset_ns;
    }
    late_datagrams_ = std::min(late_datagrams_ + 1, kLateDatagrams);
    late_least_ns_ = std::min(late_least_ns_, offset_ns);
    return late_datagrams_ == kLateDatagrams && now_ns - late_began_ns_ >= kLateFor_ns;
  }

  bool has_begun_ = false;
  std::int64_t applied_ns_ = 0;
  std::int64_t least_ns_ = 0;    // of this window
  std::int64_t earlier_ns_ = 0;  // of the one before
  std::int64_t window_began_ns_ = 0;
  std::int64_t followed_ns_ = 0;
  int late_datagrams_ = 0;  // one after the other
  std::int64_t late_began_ns_ = 0;
  std::int64_t late_least_ns_ = 0;
  std::uint64_t steps_ = 0;
  bool has_stamp_ = false;
  bool is_unusable_ = false;
  std::int64_t stamp_us_ = 0;        // the newest
  std::int64_t stamp_began_ns_ = 0;  // its first arrival
  int repeats_ = 0;
};

}  // namespace dance
