// ReplayIndex: what a player has to know of a recorded night to show it from any moment on: when it
// was, who danced when, where the beats are, and checkpoints from which to read. It is kept in a
// file beside the log, so that a night is looked through once.
//
// Units/frames: MonoTime of the recorded house's clock; an event's time less wall_ahead_us is such
//               a time. Offsets are bytes in the log.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      read_index() refuses bytes that are damaged, of another version, or out of bounds,
//               each with its reason: then the index is made anew.
// Source:       docs/replay.md#the-index has the format byte by byte.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

// Which log an index is of. A log that was changed, or goes on, has another mark.
struct LogMark {
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;  // since 1970
  std::uint64_t ends_hash = 0;  // of its first and last 64 KiB
  bool operator==(const LogMark&) const = default;
};

struct ReplayIndex {
  struct Guest {
    GuestId id;
    MonoTime first, last;
    std::uint64_t poses = 0;
  };
  // No pose of a guest for longer than kLongestStep, between two that came.
  struct Gap {
    std::uint32_t guest = 0;
    MonoTime begin, end;
  };
  struct WholeBeat {
    double beat = 0.0;
    MonoTime time;
    std::uint8_t beats_per_bar = 0;  // 0: not known
  };
  // From here the state of any moment at least kLeadIn later can be had: `state` is what was
  // measured up to at_bytes; packed channels are read from from_bytes on, where each that is in use
  // has had its last intra frame or has it still before it.
  struct Checkpoint {
    std::uint64_t at_bytes = 0;
    std::uint64_t from_bytes = 0;
    std::int64_t reached_us = 0;  // the newest time of an event before at_bytes
    std::vector<std::uint8_t> state;
  };
  static constexpr Duration kLongestStep = Duration::ms(250);
  static constexpr Duration kLeadIn = Duration::s(5);

  LogMark log;
  bool stage_only = false;  // the states are those of a board that shows the stage only
  std::uint64_t clock_id = 0;
  std::int64_t wall_ahead_us = 0;
  MonoTime begin, end;
  std::vector<Guest> guests;  // in the order in which they came
  std::vector<Gap> gaps;      // by their ends
  std::uint64_t gaps_left_out = 0;
  std::vector<WholeBeat> beats;         // in the order of the recording
  std::vector<std::uint32_t> density;   // poses in each of so many equal parts
  std::vector<Checkpoint> checkpoints;  // the first is the beginning of the log

  // When the music was at that beat; nullopt where it never was.
  std::optional<MonoTime> time_of_beat(double beat) const;
  // The last one from which the state of that moment can be had. There is one.
  const Checkpoint& checkpoint_for(MonoTime moment) const;
};

struct ReplayIndexLimits {
  static constexpr std::size_t kGuests = 256;
  static constexpr std::size_t kGaps = 100'000;
  static constexpr std::size_t kBeats = 1'000'000;
  static constexpr std::size_t kDensity = 4096;
  static constexpr std::size_t kCheckpoints = 1'000'000;
  static constexpr std::size_t kState_bytes = 1 << 20;
  static constexpr std::size_t kFile_bytes = std::size_t{1} << 30;
};

std::vector<std::uint8_t> write_index(const ReplayIndex& index);
Result<ReplayIndex> read_index(std::span<const std::uint8_t> bytes);

}  // namespace dance
