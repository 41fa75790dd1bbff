// The payload of a record or a skeleton as a stranger would send it. The first byte says which.
#include "core/base/assert.h"
#include "core/codec/plain_codec.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(plain_codec) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> payload(data + 1, size - 1);
  if (data[0] % 2 == 0) {
    dance::PlainDecoder decoder;
    dance::Pose pose;
    if (decoder.decode(1, payload, pose) != dance::DecodeResult::kPose) return 0;
    DANCE_ASSERT(dance::is_valid(pose));
    // What was let through can be sent on.
    dance::PlainEncoder encoder;
    std::array<std::uint8_t, dance::kMaxPosePayload> again;
    DANCE_ASSERT(encoder.encode(pose, again) > 0);
  } else {
    dance::Skeleton skeleton;
    if (dance::decode_skeleton(payload, skeleton)) DANCE_ASSERT(dance::is_valid(skeleton));
  }
  return 0;
}
