// StreamClock: maps frames of a sound stream to times, from the positions that the sound server
// reports a few times a second: they have jitter, and the sound card's clock drifts.
//
// Units/frames: frames of the stream; times of this house's clock.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_known() is false before a few reports. Reports that have jumped (the sound had a
//               gap) are accepted when three in a row have, and counted.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class StreamClock {
 public:
  explicit StreamClock(double rate_hz) : rate_hz_(rate_hz), frames_per_s_(rate_hz) {}

  void report(MonoTime at, double frame) {
    if (reports_ == 0) {
      restart(at, frame);
      return;
    }
    const double error_s = (frame - frame_at(at)) / rate_hz_;
    if (std::abs(error_s) > kJump_s) {
      if (++outliers_ < kJumpReports) return;
      ++jumps_;
      restart(at, frame);
      return;
    }
    outliers_ = 0;
    ++reports_;
    const double weight = reports_ < kSettled ? 1.0 / reports_ : 1.0 / kSettled;
    frame_ = frame_at(at) + weight * error_s * rate_hz_;
    at_ = at;
  }
  // The stream is played faster or slower from now on.
  void set_speed(double speed, MonoTime now) {
    frame_ = frame_at(now);
    at_ = now;
    frames_per_s_ = rate_hz_ * speed;
  }

  bool is_known() const { return reports_ >= kEnough; }
  double frame_at(MonoTime t) const { return frame_ + (t - at_).as_seconds() * frames_per_s_; }
  MonoTime time_of(double frame) const {
    return at_ + Duration::seconds((frame - frame_) / frames_per_s_);
  }
  std::uint64_t jumps() const { return jumps_; }

 private:
  static constexpr int kEnough = 3;
  static constexpr int kSettled = 16;
  static constexpr int kJumpReports = 3;
  static constexpr double kJump_s = 0.015;

  void restart(MonoTime at, double frame) {
    at_ = at;
    frame_ = frame;
    reports_ = 1;
    outliers_ = 0;
  }

  double rate_hz_;
  double frames_per_s_;
  MonoTime at_;
  double frame_ = 0.0;
  int reports_ = 0;
  int outliers_ = 0;
  std::uint64_t jumps_ = 0;
};

}  // namespace dance
