// The face codec: 52 expressions, head and gaze, intra messages without state. Most expressions are
// not shown at a moment, and right ones are like left ones: 8 to 16 bytes for a face that talks, 5
// for one at rest.
//
// Units/frames: as Face in core/pose/face.h; layout in docs/codec.md.
// Ownership:    no state, no heap.
// Threads:      none inside.
// Failure:      encode_face() gives 0 for what is not is_valid() or does not fit; decode_face()
//               false for what the encoder never makes. Its result is_valid(). Times, clock and
//               sequence do not travel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/pose/face.h"

namespace dance {

// Half a step.
constexpr float kFaceWeightError = 0.5f / 31.0f;
constexpr float kFaceHeadError_deg = 1.3f;
constexpr float kFaceGazeError_deg = 1.5f;
constexpr std::size_t kMaxFacePayload = 128;

std::size_t encode_face(const Face& face, std::span<std::uint8_t> payload);
bool decode_face(std::span<const std::uint8_t> payload, Face& face);

}  // namespace dance
