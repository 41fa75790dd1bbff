// FilePace: how fast chunks of files go, so that poses never wait for them: a token bucket whose
// rate falls to half where the round trip grows or chunks are lost, and comes back slowly.
//
// Units/frames: bytes; MonoTime of one clock.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      take() is false where it is too early; ready_at() says until when.
#pragma once

#include "core/base/time.h"

namespace dance {

class FilePace {
 public:
  FilePace() = default;  // nothing goes
  FilePace(double bytes_per_second, double burst_bytes);

  bool take(double bytes, MonoTime now);
  // Whether take() would be true.
  bool has(double bytes, MonoTime now);
  // When take() will be true of so many, which may have been long ago; MonoTime() = never.
  MonoTime ready_at(double bytes) const;

  // What the path tells.
  void see_round_trip(Duration round_trip, MonoTime now);
  void see_arrival() { see(0.0f); }
  void see_loss(MonoTime now);

  // Of the rate that was given: 1 on a good path.
  double share() const { return share_; }
  double bytes_per_second() const { return rate_ * share_; }

 private:
  void see(float lost) { lost_share_ += (lost - lost_share_) / kRemembered; }
  void slow_down(MonoTime now);
  void fill(MonoTime now);

  static constexpr float kRemembered = 32.0f;  // chunks
  double rate_ = 0.0;
  double burst_ = 0.0;
  double level_ = 0.0;
  double share_ = 1.0;
  MonoTime filled_at_;
  MonoTime slowed_at_;
  float lost_share_ = 0.0f;
  // The shortest round trip of this half minute and of the one before.
  Duration shortest_, shortest_before_;
  MonoTime window_begin_;
};

}  // namespace dance
