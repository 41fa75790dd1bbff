// Playout: what a stage shows of a guest, and why, as the manager tells it once a second.
//
// Units/frames: as lcmtypes/playout_t.lcm says; NaN where a figure is not known.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for an unknown reason, and what is infinite or out of range.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

enum class PlayoutReason : std::uint8_t {
  kNoRhythm,
  kMusicMissing,
  kBeatUnknown,  // of the dancer
  kAsked,
  kGoodEnough,  // predictions, for what has not arrived
  kTooFar,      // for predictions
  kNotMeasured,
};
constexpr std::size_t kPlayoutReasons = 7;

struct Playout {
  static constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();

  MonoTime time;
  std::uint64_t clock_id = 0;
  PlayoutReason reason = PlayoutReason::kNoRhythm;
  float beats = kNotKnown;
  float delay_ms = kNotKnown;
  float ahead_ms = kNotKnown;
  float error_mm = kNotKnown;
  float limit_mm = kNotKnown;
  float partner_share = 0.0f;
  GuestId partner;  // not set: none
};

bool is_valid(const Playout& playout);

// One line for a person: "1 beat behind: predictions as far ahead as poses are late are 74 mm off,
// 60 are allowed; beside alice".
std::string playout_text(const Playout& playout);

}  // namespace dance
