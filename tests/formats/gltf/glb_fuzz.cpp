// libFuzzer target: any bytes through the GLB reader and the retargeting; what it makes of them is
// valid, and is written and read again.
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"
#include "formats/gltf/glb.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(glb) {
  dance::GlbLimits limits;
  limits.json_objects = 2048;
  limits.nodes = 256;
  limits.frames = 500;
  limits.values = 100'000;
  limits.clips = 8;
  const auto clips = dance::read_glb(std::span(data, size), limits);
  if (!clips) {
    DANCE_ASSERT(!clips.error().what.empty());
    for (const char c : clips.error().what) DANCE_ASSERT(c >= 0x20 && c < 0x7f, c);
    return 0;
  }
  DANCE_ASSERT(!clips->empty());
  for (const dance::NamedClip& named : *clips) {
    DANCE_ASSERT(dance::is_valid(named.clip.skeleton));
    DANCE_ASSERT(!named.clip.frames.empty() && named.clip.frame_hz > 0.0);
    for (const auto& pose : named.clip.frames) DANCE_ASSERT(dance::is_valid(pose));
    for (const auto& hands : named.clip.hands) DANCE_ASSERT(dance::is_valid(hands));
  }
  dance::GlbOptions options;
  options.has_bodies = false;
  const auto again = dance::write_glb(*clips, options);
  DANCE_ASSERT(again.has_value());
  return 0;
}
