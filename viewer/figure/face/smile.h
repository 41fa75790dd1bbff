// Smiling: an estimate of how much two dancers enjoy their dance: they are near, face each other,
// hold hands, and step on the beat.
//
// Units/frames: 0 = at rest … 1.
// Threads:      any.
#pragma once

#include <span>

#include "core/base/time.h"
#include "viewer/figure/face/dancer_view.h"

namespace dance {

constexpr float kMostSmile = 0.6f;

// How much `a` enjoys dancing with `b`.
float enjoyment_of(const DancerView& a, const DancerView& b);

// The target of the smile of views[self], for the partner with the highest enjoyment.
float smile_towards(std::span<const DancerView> views, std::size_t self, MonoTime time);

}  // namespace dance
