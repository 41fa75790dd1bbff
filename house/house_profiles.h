// HouseProfiles: publishes the shown names of this house's guests, and whether this house records
// the room's dancers, to the other houses and to this house's windows. A window reports its
// recording on RECORDING/local; a file that the house writes itself counts from the start. A window
// renames a guest by PROFILE/capture; the name in it replaces that of the house file.
//
// Units/frames: MonoTime of this house's clock.
// Ownership:    refers to the port, which must outlive it; at most kMostWindows windows.
// Threads:      the poller's.
// Failure:      none. A window that ends without a report still counts for kWindowHolds.
#pragma once

#include <array>
#include <vector>

#include "core/base/fixed_list.h"
#include "core/bus/signal_port.h"
#include "house/session.h"

namespace dance {

class HouseProfiles {
 public:
  static constexpr Duration kWindowHolds = Duration::s(3);  // it reports once a second
  static constexpr std::size_t kMostWindows = 8;

  // Subscribes to RECORDING/local and PROFILE/capture on `inputs`, and publishes on `port`.
  HouseProfiles(const HouseConfig& session, SignalPort& inputs, SignalPort& port,
                std::uint64_t clock_id);

  HouseProfiles(const HouseProfiles&) = delete;
  HouseProfiles& operator=(const HouseProfiles&) = delete;

  // Publishes again the profiles that have a name or a sign, for programs that start later.
  void publish_second(MonoTime now);
  bool is_recording() const { return records_itself_ || !windows_.empty(); }

 private:
  struct Own {
    GuestId guest;
    ShownName name;
    bool is_published = false;  // published once; then the end of a sign is published, too
  };
  struct Window {
    std::uint64_t viewer = 0;
    MonoTime reported;
  };
  void on_recording(const RecordingState& state, MonoTime now);
  void on_profile(const GuestId& guest, const Profile& profile, MonoTime now);
  void publish(MonoTime now);

  SignalPort& port_;
  std::uint64_t clock_id_;
  std::vector<Own> guests_;
  bool records_itself_ = false;
  FixedList<Window, kMostWindows> windows_;  // that record now
  // Times of the newest profiles from here, which come back over the bus; in µs, as there.
  std::array<std::int64_t, 16> published_us_{};
  std::size_t next_published_ = 0;
};

}  // namespace dance
