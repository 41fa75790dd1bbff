// A pair of hands as a stranger would send it.
#include "core/base/assert.h"
#include "core/codec/hands_codec.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(hands_codec) {
  dance::Hands hands;
  if (!dance::decode_hands({data, size}, hands)) return 0;
  DANCE_ASSERT(dance::is_valid(hands));
  // What was let through can be sent on.
  std::array<std::uint8_t, dance::kMaxHandsPayload> again;
  const std::size_t again_size = dance::encode_hands(hands, again);
  DANCE_ASSERT(again_size > 0);
  dance::Hands same;
  DANCE_ASSERT(dance::decode_hands({again.data(), again_size}, same));
  DANCE_ASSERT(same.presence == hands.presence);
  return 0;
}
