// What goes over the bus beside poses, skeletons and hands: the roster, counters and what a display
// has shown. The same fields as the .lcm files of lcmtypes, which say what each means, in this
// tree's types.
//
// Units/frames: MonoTime of the clock that clock_id names; rates in Hz; ages in ms.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

// A dancer's body, and when it was measured.
struct TimedSkeleton {
  Skeleton skeleton;
  MonoTime capture_time;
  std::uint64_t clock_id = 0;
};

struct GuestStatus {
  MonoTime time;
  std::uint64_t clock_id = 0;
  bool alive = false;
  bool remote = false;
  float arrival_hz = 0.0f;
  float stage_hz = 0.0f;
  float age_p50_ms = 0.0f;
  float age_p99_ms = 0.0f;
  std::int64_t received = 0;
  std::int64_t lost = 0;
};

struct Stats {
  MonoTime time;
  std::uint64_t clock_id = 0;
  Duration uptime;
  std::int64_t received = 0;
  std::int64_t forwarded = 0;
  std::int64_t superseded = 0;
  std::int64_t dropped_late = 0;
  std::int64_t dropped_invalid = 0;
  std::int64_t dropped_unrouted = 0;
  std::int64_t dropped_overflow = 0;
  std::int64_t lost = 0;
  std::int64_t bytes_in = 0;
  std::int64_t bytes_out = 0;
  std::int64_t datagrams_in = 0;
  std::int64_t datagrams_out = 0;
  std::int64_t rejected_datagrams = 0;
  std::int64_t guests = 0;
  std::int64_t sessions = 0;
  std::int64_t reconnects = 0;
  Duration round_trip;
  Duration clock_offset;
  Duration lateness_p99;
};

struct StageTime {
  std::uint64_t clock_id = 0;
  std::uint32_t sequence = 0;
  MonoTime capture_time;
  std::array<MonoTime, kHopCount> hops{};
  MonoTime heard_time;
  MonoTime swap_time;
};

}  // namespace dance
