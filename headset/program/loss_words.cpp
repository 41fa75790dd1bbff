#include "headset/program/loss_words.h"

#include "core/program/talk.h"
#include "producers/trackers/tracker_frame.h"

namespace dance {

void LossWords::tell(std::uint32_t lost) {
  const std::uint32_t changed = lost ^ told_;
  told_ = lost;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((changed >> i & 1u) == 0) continue;
    if ((lost >> i & 1u) != 0)
      talk::warn("{} is not tracked any more; the dance goes on without it", kTrackedPointNames[i]);
    else
      talk::info("{} is tracked again", kTrackedPointNames[i]);
  }
}

}  // namespace dance
