// Roster: who is on this house's stage, and how well their poses arrive: rates, ages, losses, alive
// or silent.
//
// Units/frames: times of this house's clock; ages only from poses whose clock is ours and whose
//               capture is less than 10 s back (a replay's old stamps say nothing of latency).
// Ownership:    room for kMaxGuests; a silent guest's place goes to a newcomer when it is full, so
//               entries are looked up, not kept. Never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a guest beyond the bound is refused (nullptr) and the caller counts it.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/base/histogram.h"
#include "core/bus/messages.h"
#include "core/pose/pose.h"

namespace dance {

constexpr std::size_t kMaxGuests = 128;

struct RosterEntry {
  GuestId guest;
  bool remote = false;
  bool alive = false;
  MonoTime last_heard;
  std::uint32_t last_sequence = 0;
  std::int64_t received = 0;
  std::int64_t lost = 0;
  std::int64_t received_this_second = 0;
  std::int64_t staged_this_second = 0;
  Histogram age;  // of this second
};

class Roster {
 public:
  static constexpr Duration kSilence = Duration::s(2);

  // A pose of this guest has arrived. nullptr when there is no room.
  RosterEntry* heard(const GuestId& guest, bool remote, const Pose& pose, MonoTime now);
  // A pose of this guest was put on the stage.
  static void staged(RosterEntry& entry, const Pose& pose, MonoTime now,
                     std::uint64_t our_clock_id);

  // Ends the second: hands each guest's status to `say` and begins to count anew; guests gone
  // silent are said once more, as not alive, and then left out until they return.
  template <class Say>
  void end_second(MonoTime now, std::uint64_t our_clock_id, Say say) {
    for (std::size_t i = 0; i < size_; ++i) {
      RosterEntry& entry = entries_[i];
      const bool was_alive = entry.alive;
      entry.alive = now - entry.last_heard < kSilence;
      if (entry.alive || was_alive) say(entry, status_of(entry, now, our_clock_id));
      entry.received_this_second = entry.staged_this_second = 0;
      entry.age.clear();
    }
  }

  std::int64_t alive_count() const;
  // nullptr for a guest who was never heard, or whose place was given to another.
  RosterEntry* find(const GuestId& guest);

 private:
  static GuestStatus status_of(const RosterEntry& entry, MonoTime now, std::uint64_t our_clock_id);
  RosterEntry* find_or_add(const GuestId& guest);

  std::array<RosterEntry, kMaxGuests> entries_;
  std::size_t size_ = 0;
};

}  // namespace dance
