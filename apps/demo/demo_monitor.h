// DemoMonitor: listens to both houses of a demo and keeps account of every dancer: poses sent,
// delivered to the other house, and how old they were at each step of the way.
//
// Units/frames: both houses share this machine's clock; ages count from capture.
// Ownership:    refers to the buses, which must outlive it; room for kMaxGuests dancers.
// Threads:      none inside; runs in the poller's thread.
// Failure:      poses of guests beyond the bound are not counted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/histogram.h"
#include "core/bus/signal_port.h"

namespace dance {

// The first hop that is the stage's own: those before it are the way here.
constexpr auto kFirstOfStage = static_cast<std::size_t>(Hop::kStageTaken);

// Which sequence numbers were seen, over the last 2^16: enough to tell a doubled or late pose from
// a new one.
class SequenceSet {
 public:
  SequenceSet() : bits_(kSize / 64) {}
  // False when it was in already.
  bool insert(std::uint32_t sequence);

 private:
  static constexpr std::uint32_t kSize = 1u << 16;
  std::vector<std::uint64_t> bits_;
  std::uint32_t newest_ = 0;
  bool any_ = false;
};

struct DancerAccount {
  GuestId guest;
  int house = 0;  // 0 = A, 1 = B: where this dancer is
  std::int64_t sent = 0;
  std::int64_t delivered = 0;
  std::int64_t staged = 0;  // poses put on the other house's stage
  std::int64_t staged_at_home = 0;
  std::array<Histogram, kHopCount> age_at_hop;  // of poses staged in the other house
  Histogram age_at_home;                        // on the dancer's own stage

  SequenceSet sent_set;
  SequenceSet delivered_set;
};

class DemoMonitor {
 public:
  DemoMonitor(SignalPort& bus_a, SignalPort& bus_b);

  const std::vector<DancerAccount>& accounts() const { return accounts_; }
  // From now on poses on the stage are those of dancers who have stopped: their age tells nothing.
  void stop_timing() { timing_ = false; }
  // Newest report of each house's link: whether it is in session with the server.
  bool is_connected(int house) const { return connected_[static_cast<std::size_t>(house)]; }
  // Whether the music of the house has begun.
  bool has_music(int house) const { return has_music_[static_cast<std::size_t>(house)]; }

 private:
  void listen(SignalPort& bus, int house);
  DancerAccount* account_of(const GuestId& guest);
  void on_staged(DancerAccount& account, int house, const Pose& pose);
  void on_arrived(DancerAccount& account, int house, const Pose& pose);

  std::vector<DancerAccount> accounts_;
  bool timing_ = true;
  std::array<bool, 2> connected_{};
  std::array<bool, 2> has_music_{};
};

}  // namespace dance
