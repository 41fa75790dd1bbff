// Style: gains by which a guest's dance is shown larger or smaller, zone by zone.
//
// Units/frames: gains: 0 = no motion, 1 = as danced, up to 4; as lcmtypes/style_t.lcm says.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what is not finite or out of range.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

enum class BodyZone : std::uint8_t { kHips, kTorso, kShoulders, kArms, kHands, kLegs, kHead };
constexpr std::size_t kBodyZones = 7;
constexpr float kMostStyleGain = 4.0f;

struct Style {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::array<float, kBodyZones> gain{1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
  float periodic = 1.0f;
  float dynamic = 1.0f;
};

bool is_valid(const Style& style);

}  // namespace dance
