// The hands codec: 30 finger bones, intra messages without state. Every rotation is an index on a
// grid of rotation vectors, within half a degree whatever it is; fingers curl alike, so an index is
// coded as its difference from the neighbour's. 25 to 60 bytes for both hands in a natural pose, 11
// at rest, 1 where there are none.
//
// Units/frames: as Hands in core/pose/pose.h; layout in docs/codec.md.
// Ownership:    no state, no heap.
// Threads:      none inside.
// Failure:      encode_hands() gives 0 for what is not is_valid() or does not fit; decode_hands()
//               false for what the encoder never makes. Its result is_valid(), with the same bits
//               on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/pose/pose.h"

namespace dance {

// Half the diagonal of the grid's cell; a turn is never further than its rotation vector.
constexpr double kHandsError_deg = 0.5;
// Longest payload: 23 bits at most for each of 90 numbers, and two masks.
constexpr std::size_t kMaxHandsPayload = 272;

std::size_t encode_hands(const Hands& hands, std::span<std::uint8_t> payload);
bool decode_hands(std::span<const std::uint8_t> payload, Hands& hands);

}  // namespace dance
