// LeastTransit: the least time that poses took lately from capture to arrival: what a line takes
// when nothing is in the way.
//
// Units/frames: from capture time to arrival, of whatever clocks; all of them share the offset.
//               Lately is 5 to 10 s.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      of no pose it is 0.
// Source:       the clock filter of NTP, RFC 5905.
#pragma once

#include <algorithm>
#include <array>

#include "core/base/time.h"

namespace dance {

class LeastTransit {
 public:
  // Returns true with the first since forget().
  bool add(Duration transit, MonoTime now) {
    const bool is_first = !buckets_[0].filled;
    if (is_first || now - begin_ > kBucketLength) {
      buckets_[1] = buckets_[0];
      buckets_[0] = {transit, true};
      begin_ = now;
    }
    buckets_[0].least = std::min(buckets_[0].least, transit);
    return is_first;
  }
  Duration value() const {
    return buckets_[1].filled ? std::min(buckets_[0].least, buckets_[1].least) : buckets_[0].least;
  }
  void forget() { buckets_ = {}; }

 private:
  // One bucket is filled while the other still counts.
  static constexpr Duration kBucketLength = Duration::s(5);
  struct Bucket {
    Duration least;
    bool filled = false;
  };
  std::array<Bucket, 2> buckets_{};
  MonoTime begin_;
};

}  // namespace dance
