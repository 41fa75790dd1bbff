// Guests, moments and poses by number, for the tests of the manager.
//
// Units/frames: as core/pose/pose.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "core/pose/pose.h"

namespace dance {

constexpr std::uint64_t kClock = 5;

inline GuestId guest(const std::string& name) { return *GuestId::parse(name); }
inline MonoTime at_ms(double ms) { return MonoTime::from_ns(static_cast<std::int64_t>(ms * 1e6)); }

// The hips tell which one it is.
inline Pose pose_of(std::uint32_t sequence, MonoTime capture) {
  Pose pose;
  pose.sequence = sequence;
  pose.capture_time = capture;
  pose.clock_id = kClock;
  pose.p_WH_m.x() = static_cast<float>(sequence);
  return pose;
}

}  // namespace dance
