// Counts durations in fixed buckets (32 per octave, so percentiles are within 2.2 %), without
// allocation: latencies, lateness and ages over a second or over hours.
//
// Units/frames: microseconds from 0 to 2^32; larger values are counted in the last bucket, negative
//               ones in the first.
// Threads:      none inside; one owner.
// Failure:      percentiles of an empty histogram are 0.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class Histogram {
 public:
  void add(Duration d) {
    const std::int64_t us = d.count_us();
    ++buckets_[bucket_of(us < 0 ? 0 : static_cast<std::uint64_t>(us))];
    ++count_;
    if (d > max_) max_ = d;
  }
  void add(const Histogram& more) {
    for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += more.buckets_[i];
    count_ += more.count_;
    max_ = std::max(max_, more.max_);
  }
  void clear() { *this = Histogram(); }
  std::uint64_t count() const { return count_; }
  Duration max() const { return max_; }

  // fraction in [0, 1]: 0.5 is the median.
  Duration percentile(double fraction) const {
    if (count_ == 0) return {};
    auto rank = static_cast<std::uint64_t>(fraction * static_cast<double>(count_ - 1));
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      if (rank < buckets_[i])  // a bucket's middle may lie above the maximum
        return std::min(max_, Duration::us(static_cast<std::int64_t>(middle_of(i))));
      rank -= buckets_[i];
    }
    return max_;
  }

 private:
  static constexpr unsigned kSubBits = 5;
  static constexpr std::size_t kBuckets = (32 - kSubBits + 1) << kSubBits;

  static std::size_t bucket_of(std::uint64_t us) {
    if (us < (1u << kSubBits)) return us;
    const unsigned octave = static_cast<unsigned>(std::bit_width(us)) - 1 - kSubBits;
    const std::size_t bucket =
        ((octave + 1u) << kSubBits) + ((us >> octave) & ((1u << kSubBits) - 1));
    return bucket < kBuckets ? bucket : kBuckets - 1;
  }
  static std::uint64_t middle_of(std::size_t bucket) {
    if (bucket < (1u << kSubBits)) return bucket;
    const unsigned octave = static_cast<unsigned>(bucket >> kSubBits) - 1;
    const std::uint64_t low = ((1u << kSubBits) + (bucket & ((1u << kSubBits) - 1))) << octave;
    return low + ((1ULL << octave) >> 1);
  }

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  Duration max_;
};

}  // namespace dance
