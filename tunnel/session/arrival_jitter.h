// How unevenly one guest's poses arrive: the interarrival jitter of RTP, from capture and arrival.
//
// Units/frames: microseconds; captures in any clock of the same rate, as only differences count.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; the caller sees to it that captures are near to now.
// Source:       RFC 3550, section 6.4.1 and appendix A.8.
#pragma once

#include <cstdint>

#include "core/base/time.h"

namespace dance {

class ArrivalJitter {
 public:
  // D(i−1, i) = (R_i − S_i) − (R_{i−1} − S_{i−1});  J += (|D| − J) / 16
  void add(std::int64_t capture_us, std::int64_t received_us) {
    const std::int64_t transit_us = received_us - capture_us;
    if (has_any_) {
      const std::int64_t change_us = transit_us - transit_us_;
      const auto size_us = static_cast<double>(change_us < 0 ? -change_us : change_us);
      jitter_us_ += (size_us - jitter_us_) * (1.0 / 16.0);
    }
    has_any_ = true;
    transit_us_ = transit_us;
  }
  bool has_any() const { return has_any_; }
  Duration jitter() const { return Duration::seconds(jitter_us_ * 1e-6); }

 private:
  bool has_any_ = false;
  std::int64_t transit_us_ = 0;
  double jitter_us_ = 0.0;
};

}  // namespace dance
