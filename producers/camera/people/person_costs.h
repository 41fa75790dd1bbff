// What speaks against a body's being a person's: squares over variances, each bounded.
//
// Units/frames: `_sides` are sides of the person's region; the others are numbers.
// Ownership:    constants.
// Threads:      none.
// Failure:      none.
#pragma once

namespace dance {

// Of its place, and of the distance of its colours from the person's.
constexpr float kPlaceSd_sides = 0.1f, kMostPlace = 12.0f;
constexpr float kLookWeight = 1.5f;

}  // namespace dance
