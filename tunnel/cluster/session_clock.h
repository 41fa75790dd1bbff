// The clock that all servers of a cluster show to their links: that of the server that was there
// first. Each server follows it, so that a guest who comes to another server, music and captures
// stay on one scale. Where the first one ends the next goes on from what it had.
//
// Units/frames: ours is this process's MonoTime, session time is a MonoTime too. What is left
//               between servers is half the difference of the two directions' shortest delays.
// Ownership:    plain value; never allocates.
// Threads:      none inside.
// Failure:      steps() counts jumps; there is one when a server joins, before it has links.
#pragma once

#include "core/net/clock_mapper.h"

namespace dance {

class SessionClock {
 public:
  MonoTime to_session(MonoTime ours) const { return ours + offset_; }
  MonoTime to_ours(MonoTime session) const { return session - offset_; }

  // Another server's clock leads now, or ours: what was measured of the one before counts no more.
  void begin() { mapper_.reset(), samples_ = 0; }
  void add(const ClockMapper::Sample& sample);
  // Follows what is measured, so slowly that nothing jumps.
  void advance(MonoTime now);

  bool is_measured() const { return samples_ >= kEnough; }
  Duration offset() const { return offset_; }
  Duration round_trip() const { return mapper_.shortest_round_trip(); }
  std::uint64_t steps() const { return steps_; }

 private:
  static constexpr int kEnough = 8;

  ClockMapper mapper_;
  Duration offset_;  // session − ours
  MonoTime advanced_;
  int samples_ = 0;
  std::int64_t slew_left_ = 0;  // in 10⁻⁶ ns
  std::uint64_t steps_ = 0;
};

}  // namespace dance
