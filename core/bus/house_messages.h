// What parts of a house tell its windows beside the dance: how its link stands, how loud its
// microphones are; and what a window asks of the link. The same fields as the .lcm files of
// lcmtypes, which say what each means.
//
// Units/frames: MonoTime of the clock that clock_id names; levels in dBFS.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what the .lcm files do not allow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

enum class HouseLinkState : std::int8_t { kConnecting, kConnected, kLapsed };

enum class HouseLinkTrouble : std::int8_t {
  kNone,
  kNoAnswer,
  kWrongKey,
  kNotTrusted,
  kInterrupted,
  kRefused,
  kRemoved,
  kServerKeyChanged,
  kClosed,  // the server ended with a goodbye
};

enum class RemovalVerdict : std::int8_t {
  kAsked,  // not answered yet
  kDone,
  kNotAllowed,
  kNoSuchGuest,
  kPassedOn,
  kTooMany,
  kNoAnswer,
  kOwnGuest,
};

struct HouseLink {
  MonoTime time;
  std::uint64_t clock_id = 0;
  HouseLinkState state = HouseLinkState::kConnecting;
  HouseLinkTrouble trouble = HouseLinkTrouble::kNone;
  int refusal = 0;  // wire::Refusal
  GuestId refused;
  MonoTime asks_again;
  bool may_remove = false;
  std::int32_t removal = 0;
  RemovalVerdict verdict = RemovalVerdict::kAsked;
};

struct Removal {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::int32_t number = 0;
  GuestId guest;
};

// Of whom a window wants no poses.
struct InterestWish {
  static constexpr std::size_t kMostHidden = 24;

  MonoTime time;
  std::uint64_t clock_id = 0;
  std::uint64_t viewer = 0;                   // tells it from other windows of the house
  std::array<GuestId, kMostHidden> hidden{};  // those that are set
};

struct VoiceLevel {
  MonoTime time;
  std::uint64_t clock_id = 0;
  int level_dbfs = -127;
  int cleaned_dbfs = -127;
};

// A window of this house reports whether it records.
struct RecordingState {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::uint64_t viewer = 0;  // identifies the window among those of the house
  bool is_recording = false;
};

inline bool is_valid(const HouseLink& link) {
  const auto is_within = [](auto value, auto last) {
    return static_cast<int>(value) >= 0 && value <= last;
  };
  return is_within(link.state, HouseLinkState::kLapsed) &&
         is_within(link.trouble, HouseLinkTrouble::kClosed) &&
         is_within(link.verdict, RemovalVerdict::kOwnGuest) && link.refusal >= 0;
}
inline bool is_valid(const Removal& removal) {
  return removal.guest.is_set() && removal.number != 0;
}
inline bool is_valid(const InterestWish& wish) { return wish.viewer != 0; }
inline bool is_valid(const RecordingState& state) { return state.viewer != 0; }
inline bool is_valid(const VoiceLevel& level) {
  return level.level_dbfs >= -127 && level.level_dbfs <= 0 && level.cleaned_dbfs >= -127 &&
         level.cleaned_dbfs <= 0;
}

}  // namespace dance
