// A face as a stranger would send it.
#include "core/base/assert.h"
#include "core/codec/face_codec.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(face_codec) {
  dance::Face face;
  if (!dance::decode_face({data, size}, face)) return 0;
  DANCE_ASSERT(dance::is_valid(face));
  // What was let through can be sent on.
  std::array<std::uint8_t, dance::kMaxFacePayload> again;
  const std::size_t again_size = dance::encode_face(face, again);
  DANCE_ASSERT(again_size > 0);
  dance::Face same;
  DANCE_ASSERT(dance::decode_face({again.data(), again_size}, same));
  DANCE_ASSERT(same.presence == face.presence);
  return 0;
}
