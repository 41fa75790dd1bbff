// InstrumentsMeter: a GuestMeter for each guest of a house, and this house's music for all of them.
//
// Units/frames: times of the house's clock.
// Ownership:    room for kMaxGuests; allocates when it is made, and never again.
// Threads:      none inside; one owner: the thread that hears the bus.
// Failure:      a guest beyond the bound takes the place of one who has been silent for long, else
//               is not measured.
#pragma once

#include <cstdint>
#include <memory>

#include "core/bus/channel.h"
#include "core/pose/music_here.h"
#include "viewer/instruments/guest_meter.h"

namespace dance {

class InstrumentsMeter {
 public:
  static constexpr std::size_t kMaxGuests = 128;

  explicit InstrumentsMeter(std::uint64_t clock_id);

  void on_pose(Where where, const GuestId& guest, const Pose& pose, MonoTime now);
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton);
  void on_beat(const Beat& beat) { music_.hear(beat); }
  void on_shown(const GuestId& guest, const StageTime& shown);
  void on_flow(const GuestId& guest, const FlowSetting& setting);
  void on_traffic(const GuestId& guest, const GuestTraffic& traffic);

  // Ten times a second or so: say(guest, stats) for each guest whose second has ended.
  template <class Say>
  void end_seconds(MonoTime now, Say say) {
    for (std::size_t i = 0; i < kMaxGuests; ++i) {
      Slot& slot = slots_[i];
      if (!slot.guest.is_set() || slot.is_twin || !slot.meter.is_due(now)) continue;
      const GuestStats stats = slot.meter.end_second(now);
      if (is_present(slot, now)) say(slot.guest, stats);
    }
  }

 private:
  struct Slot {
    GuestId guest;
    bool is_twin = false;  // NAME-raw: the same dancer once more
    MonoTime heard;
    GuestMeter meter;
  };
  static bool is_present(const Slot& slot, MonoTime now);
  Slot* slot_of(const GuestId& guest, MonoTime now);
  Slot* find(const GuestId& guest);

  std::uint64_t clock_id_;
  MusicHere music_;
  std::unique_ptr<Slot[]> slots_;
};

}  // namespace dance
