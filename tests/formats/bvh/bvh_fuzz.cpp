// libFuzzer target: any bytes through the BVH reader, the rig, the retargeting and the writer.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "formats/bvh/retarget.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(bvh) {
  dance::BvhLimits limits;
  limits.frames = 1000;
  limits.values = 100'000;
  const auto bvh =
      dance::read_bvh(std::string_view(reinterpret_cast<const char*>(data), size), limits);
  if (!bvh) {
    DANCE_ASSERT(!bvh.error().what.empty());
    return 0;
  }
  DANCE_ASSERT(bvh->values.size() == bvh->frame_count * bvh->channel_count);
  const auto retargeted = dance::retarget(*bvh);
  if (!retargeted) return 0;
  DANCE_ASSERT(dance::is_valid(retargeted->clip.skeleton));
  for (const auto& pose : retargeted->clip.frames) DANCE_ASSERT(dance::is_valid(pose));
  for (const auto& hands : retargeted->clip.hands) DANCE_ASSERT(dance::is_valid(hands));
  const auto again = dance::read_bvh(dance::write_bvh(retargeted->clip));
  DANCE_ASSERT(again.has_value());
  return 0;
}
