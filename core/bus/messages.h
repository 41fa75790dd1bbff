// What goes over the bus beside poses, skeletons and hands: the roster, counters and what a display
// has shown. The same fields as the .lcm files of lcmtypes, which say what each means, in this
// tree's types.
//
// Units/frames: MonoTime of the clock that clock_id names; rates in Hz; ages in ms.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what the .lcm files do not allow; times are checked where
//               they are read (core/bus/message_fields.h).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

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

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();

// The gaps of guest_stats_t: one for each Hop of a pose, and two of the display.
constexpr std::size_t kHeardGap = kHopCount;
constexpr std::size_t kShownGap = kHopCount + 1;
constexpr std::size_t kGapCount = kHopCount + 2;
using GapFigures = std::array<float, kGapCount>;

constexpr GapFigures no_gaps() {
  GapFigures gaps{};
  for (float& gap : gaps) gap = kNotKnown;
  return gaps;
}

struct GuestStats {
  MonoTime time;
  std::uint64_t clock_id = 0;
  GapFigures gap_p50_ms = no_gaps();
  GapFigures gap_p99_ms = no_gaps();
  float newest_p50_ms = kNotKnown;
  float newest_p99_ms = kNotKnown;
  float age_p50_ms = kNotKnown;
  float age_p99_ms = kNotKnown;
  float arrival_hz = 0.0f;
  float stage_hz = 0.0f;
  float shown_hz = 0.0f;
  float jitter_ms = kNotKnown;
  float loss_percent = kNotKnown;
  float horizon_p50_ms = kNotKnown;
  float horizon_p99_ms = kNotKnown;
  float error_mean_mm = kNotKnown;
  float error_p95_mm = kNotKnown;
  float hips_error_mm = kNotKnown;
  float beat_ms = kNotKnown;
  float beat_share = kNotKnown;
  float bytes_per_second = kNotKnown;
  float bytes_per_pose = kNotKnown;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  std::int64_t late = 0;
  std::int64_t superseded = 0;
};

struct GuestTraffic {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::int64_t bytes = 0;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  std::int64_t late = 0;
  std::int64_t duplicate = 0;
  std::int64_t invalid = 0;
  std::int64_t reference_missing = 0;
  std::int64_t key_frames_asked = 0;
};

inline bool is_valid(const TimedSkeleton& timed) { return is_valid(timed.skeleton); }
inline bool is_valid(const GuestStatus& status) {
  return std::isfinite(status.arrival_hz) && std::isfinite(status.stage_hz) &&
         std::isfinite(status.age_p50_ms) && std::isfinite(status.age_p99_ms);
}
inline bool is_valid(const Stats&) { return true; }
inline bool is_valid(const StageTime&) { return true; }
// Not known, or a number.
bool is_valid(const GuestStats& stats);
inline bool is_valid(const GuestTraffic& traffic) { return traffic.bytes >= 0; }

}  // namespace dance
