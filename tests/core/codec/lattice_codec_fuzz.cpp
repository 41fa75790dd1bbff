// Bytes as a record of the lattice codec, to a decoder in the middle of a dance.
#include <cstdlib>

#include "core/codec/lattice/lattice_codec.h"
#include "tests/core/codec/lattice_poses.h"
#include "tests/fuzz_target.h"

namespace {

using namespace dance;

void primed(LatticeDecoder& decoder) {
  LatticeEncoder encoder(built_in_model());
  Random random(1);
  std::array<std::uint8_t, kMaxPosePayload> payload{};
  Pose got;
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::size_t size = encoder.encode(dance_frame(i, random), payload);
    decoder.decode(i, {payload.data(), size}, got);
  }
}

}  // namespace

DANCE_FUZZ_TARGET(lattice_codec) {
  static LatticeDecoder decoder = [] {
    LatticeDecoder made(built_in_model());
    primed(made);
    return made;
  }();
  if (size == 0) return 0;
  // What decodes becomes a reference itself, so each input has the dance before it anew.
  if (decoder.find(5) == nullptr || decoder.find(4) == nullptr) primed(decoder);
  Pose pose;
  const std::uint32_t sequence = 6 + data[0] % 4;
  if (decoder.decode(sequence, {data + 1, size - 1}, pose) == DecodeResult::kPose &&
      !is_valid(pose))
    std::abort();
  return 0;
}
