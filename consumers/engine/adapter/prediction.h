// What a dancer does in the moments after the newest pose: the motion goes on as it was, slows down
// and stands still after kLongestPrediction, so that a stalled stream comes to rest and nobody
// flies off. For the few milliseconds between a pose and a display; a house's `predict` looks
// further.
//
// Units/frames: poses as in core/pose; with τ the time since the newest pose, s = τ / T:
//               moved(τ) = T · (s − s³ + s⁴/2), whose speed 1 − 3s² + 2s³ falls from 1 to 0 without
//               a corner; at rest the dancer has moved as in T/2.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      without a pose before the newest, near enough in time to tell a speed, the newest
//               stays. A bone that turned by more than a third of a turn is not turned on; places
//               move on by kMostPredicted_m at most.
#pragma once

#include <optional>

#include "core/base/time.h"
#include "core/pose/history.h"
#include "formats/engine/segment.h"

namespace dance::engine {

constexpr Duration kLongestPrediction = Duration::ms(100);
constexpr float kMostPredicted_m = 0.5f;

// Where a pose before the newest tells the speed: not nearer, as that is mostly noise, and not
// further, as that is another motion.
constexpr Duration kLeastBaseline = Duration::ms(10);
constexpr Duration kMostBaseline = PoseHistory::kCloseTogether;

// Of the history's newest pose, at a time after it; beyond kLongestPrediction as at its end.
Pose predict(const PoseHistory& history, MonoTime t);
// The same in place, as the memory holds poses. `before` is as far from it as said above.
void predict(StoredPose& newest, const StoredPose& before, MonoTime t);

}  // namespace dance::engine
