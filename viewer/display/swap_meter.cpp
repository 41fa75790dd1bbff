#include "viewer/display/swap_meter.h"

#include <algorithm>

namespace dance {

void SwapMeter::add(MonoTime captured, MonoTime heard, const PictureTimes& times) {
  samples_[added_++ % kMost] = {times.swapped, heard - captured, times.taken - heard,
                                times.drawn - times.taken, times.swapped - times.drawn};
}

std::optional<SwapFigures> SwapMeter::figures(MonoTime now) {
  SwapFigures sum;
  for (std::size_t back = 0; back < std::min(added_, kMost); ++back) {
    const Sample& it = samples_[(added_ - 1 - back) % kMost];
    if (now - it.swapped > kLast) break;
    sum.coming_ms += static_cast<float>(it.coming.as_ms());
    sum.waiting_ms += static_cast<float>(it.waiting.as_ms());
    sum.drawing_ms += static_cast<float>(it.drawing.as_ms());
    sum.swapping_ms += static_cast<float>(it.swapping.as_ms());
    totals_ms_[sum.poses++] =
        static_cast<float>((it.coming + it.waiting + it.drawing + it.swapping).as_ms());
  }
  if (sum.poses == 0) return std::nullopt;
  const auto n = static_cast<float>(sum.poses);
  for (float* mean : {&sum.coming_ms, &sum.waiting_ms, &sum.drawing_ms, &sum.swapping_ms})
    *mean /= n;
  const auto end = totals_ms_.begin() + static_cast<std::ptrdiff_t>(sum.poses);
  const auto percentile = [&](float fraction) {
    const auto at = totals_ms_.begin() + static_cast<std::ptrdiff_t>(fraction * (n - 1.0f));
    std::nth_element(totals_ms_.begin(), at, end);
    return *at;
  };
  sum.p50_ms = percentile(0.5f);
  sum.p99_ms = percentile(0.99f);
  return sum;
}

}  // namespace dance
