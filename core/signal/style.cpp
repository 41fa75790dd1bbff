#include "core/signal/style.h"

#include <algorithm>

namespace dance {

bool is_valid(const Style& style) {
  // The comparisons also refuse NaN.
  const auto is_gain = [](float gain) { return gain >= 0.0f && gain <= kMostStyleGain; };
  return std::all_of(style.gain.begin(), style.gain.end(), is_gain) && is_gain(style.periodic) &&
         is_gain(style.dynamic);
}

}  // namespace dance
