// SampleWindow: the samples of one second, and their mean and percentiles.
//
// Units/frames: the caller's.
// Ownership:    kMost values inside; never allocates. Of more than kMost the newest are kept.
// Threads:      none inside; one owner.
// Failure:      without samples the figures are not a number.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace dance {

template <std::size_t kMost>
class SampleWindow {
 public:
  void add(float value) { samples_[added_++ % kMost] = value; }
  void clear() { added_ = 0; }
  std::size_t count() const { return std::min(added_, kMost); }

  float mean() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < count(); ++i) sum += static_cast<double>(samples_[i]);
    return added_ > 0 ? static_cast<float>(sum / static_cast<double>(count())) : kNone;
  }
  // fraction in [0, 1]: 0.5 is the median. The order of the samples is lost.
  float percentile(double fraction) {
    if (added_ == 0) return kNone;
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(count() - 1));
    const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(count());
    std::nth_element(samples_.begin(), samples_.begin() + rank, end);
    return samples_[static_cast<std::size_t>(rank)];
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  std::array<float, kMost> samples_{};
  std::size_t added_ = 0;
};

}  // namespace dance
