// ArrivalDelays: how late packets of one guest come, against the quickest of the last seconds, and
// how long play-out has to wait so that nearly all come in time.
//
// Units/frames: a packet's delay is its arrival less its sequence times 10 ms, so that the sender's
//               clock does not matter; that of its sound card shows as a slow change, which the
//               quickest of the last seconds follows.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      before the first packet wait() is the least, and quickest() must not be asked.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class ArrivalDelays {
 public:
  // Frames are numbered without a wrap.
  void add(std::int64_t frame, MonoTime arrival);

  bool is_known() const { return count_ > 0; }
  // When the frame would arrive, or would have, if it were as quick as the quickest.
  MonoTime quickest(std::int64_t frame) const;
  // By how much later than that a frame is to be played.
  Duration wait() const { return wait_; }

 private:
  static constexpr int kBins = 256;  // of 4 ms
  static constexpr int kWindows = 5;

  void slide(MonoTime arrival, Duration delay);
  void count(Duration late);

  std::array<float, kBins> share_{};
  // The quickest of each two seconds; the least of all is the base.
  std::array<Duration, kWindows> quickest_{};
  int windows_ = 0;
  MonoTime window_begin_;
  Duration base_;
  Duration wait_ = Duration::ms(20);
  std::int64_t count_ = 0;
  double peak_ms_ = 0.0;
};

}  // namespace dance
