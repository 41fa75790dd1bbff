// A stream of lossless frames from a damaged recording: two bytes of length, lowest first, before
// each.
#include <cstring>

#include "core/base/assert.h"
#include "core/codec/lossless/lossless_codec.h"
#include "tests/fuzz_target.h"

namespace {

bool is_same(const dance::Pose& a, const dance::Pose& b) {
  return std::memcmp(a.R_PB.data(), b.R_PB.data(), sizeof a.R_PB) == 0 &&
         std::memcmp(a.p_WH_m.data(), b.p_WH_m.data(), 3 * sizeof(float)) == 0 &&
         std::memcmp(&a.confidence, &b.confidence, sizeof a.confidence) == 0 &&
         std::memcmp(&a.music_beats, &b.music_beats, sizeof a.music_beats) == 0 &&
         a.presence == b.presence;
}

}  // namespace

DANCE_FUZZ_TARGET(lossless_codec) {
  dance::LosslessDecoder decoder;
  // Whatever was let through comes back when it is written again.
  dance::LosslessEncoder again_encoder;
  dance::LosslessDecoder again_decoder;
  std::array<std::uint8_t, dance::kMaxLosslessPayload> again;
  for (std::size_t at = 0; at + 2 <= size;) {
    const std::size_t length =
        std::min(size - at - 2, static_cast<std::size_t>(data[at] | data[at + 1] << 8));
    at += 2;
    dance::Pose pose;
    if (decoder.decode({data + at, length}, pose) == dance::DecodeResult::kPose) {
      const std::size_t again_size = again_encoder.encode(pose, again);
      DANCE_ASSERT(again_size > 0);
      dance::Pose same;
      DANCE_ASSERT(again_decoder.decode({again.data(), again_size}, same) ==
                   dance::DecodeResult::kPose);
      DANCE_ASSERT(is_same(pose, same));
    }
    at += length;
  }
  return 0;
}
