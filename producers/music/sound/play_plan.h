// PlayPlan: which frame of a song goes into which frame of a sound stream, so that the song is
// heard on time in spite of latency and of the sound card's drift: small errors are corrected by
// playing up to 0.2 % faster or slower, large ones by a jump.
//
// Units/frames: stream frames count from the stream's begin; song frames are the song's seconds
//               times the rate, and may be negative: not yet begun. `begin` is when song frame 0 is
//               to be heard.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      heard_s() and song_frame() need align() first.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/sound/stream_clock.h"

namespace dance {

class PlayPlan {
 public:
  explicit PlayPlan(double rate_hz) : rate_hz_(rate_hz) {}

  bool is_aligned() const { return count_ > 0; }
  // From stream frame `written` on, the song is where it should be.
  void align(const StreamClock& clock, MonoTime begin, std::int64_t written) {
    if (count_ == kMost) std::move(parts_.begin() + 1, parts_.end(), parts_.begin());
    count_ = std::min(count_ + 1, kMost);
    parts_[count_ - 1] = {written, static_cast<std::int64_t>(std::llround(clock.frame_at(begin)))};
  }
  std::int64_t song_frame(std::int64_t stream_frame) const {
    return stream_frame - part_of(static_cast<double>(stream_frame)).shift;
  }

  // The song second that is heard at t.
  std::optional<double> heard_s(const StreamClock& clock, MonoTime t) const {
    if (!is_aligned()) return std::nullopt;
    const double frame = clock.frame_at(t);
    const Part& part = part_of(frame);
    if (frame < static_cast<double>(parts_[0].from)) return std::nullopt;
    return (frame - static_cast<double>(part.shift)) / rate_hz_;
  }
  // How far ahead of where it should be the song is, or will be once what was written before a jump
  // has been heard.
  double error_s(const StreamClock& clock, MonoTime begin, MonoTime now) const {
    const Part& part = parts_[count_ - 1];
    return (clock.frame_at(now) - static_cast<double>(part.shift)) / rate_hz_ -
           (now - begin).as_seconds();
  }
  static bool wants_jump(double error_s) { return std::abs(error_s) > kJump_s; }
  static double speed_for(double error_s) {
    if (std::abs(error_s) < kGoodEnough_s) return 1.0;
    return 1.0 - std::clamp(error_s / kCorrectionTime_s, -kMostSpeed, kMostSpeed);
  }

 private:
  struct Part {
    std::int64_t from = 0;   // stream frame
    std::int64_t shift = 0;  // stream frame of song frame 0
  };
  static constexpr std::size_t kMost = 8;
  // A gap in the sound or a lost connection; smaller errors are corrected within ten seconds,
  // inaudibly.
  static constexpr double kJump_s = 0.040;
  static constexpr double kGoodEnough_s = 0.0003;
  static constexpr double kCorrectionTime_s = 8.0;
  static constexpr double kMostSpeed = 0.002;

  const Part& part_of(double stream_frame) const {
    std::size_t i = count_ - 1;
    while (i > 0 && static_cast<double>(parts_[i].from) > stream_frame) --i;
    return parts_[i];
  }

  double rate_hz_;
  std::array<Part, kMost> parts_{};
  std::size_t count_ = 0;
};

}  // namespace dance
