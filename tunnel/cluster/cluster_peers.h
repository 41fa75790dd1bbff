// The servers of a cluster as one of them sees them: who lives, who has fallen silent, how far they
// are, and whose clock is the session clock. The one that was there first leads; where it ends the
// next goes on from what it had.
//
// Units/frames: now is this process's MonoTime.
// Ownership:    plain values; allocates when a server comes.
// Threads:      none inside.
// Failure:      beyond kMost servers further ones are not taken.
#pragma once

#include <map>
#include <vector>

#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/session_clock.h"

namespace dance {

class ClusterPeers {
 public:
  static constexpr std::size_t kMost = 256;
  struct Peer {
    cluster::Heartbeat beat;
    MonoTime heard;
    Duration round_trip;
    bool is_alive = true;
  };

  // This server, and when its clock began by its wall clock.
  ClusterPeers(ServerId self, std::int64_t born_us) : self_(self), born_us_(born_us) {}

  // Once all that are there have been heard: whatever this machine's wall clock says, it is behind
  // them, and its clock leads nobody who has links.
  void take_rank();
  std::int64_t born_us() const { return born_us_; }

  // True where it had been forgotten, and so what it had.
  bool take(const cluster::Heartbeat& beat, MonoTime now);
  void take(const cluster::ClockAnswer& answer, MonoTime now);
  // It stands in lasting values, and may be one that has ended long ago: it counts as heard
  // when it was first read of.
  void expect(ServerId server, MonoTime since);

  // Servers that were silent for so long that their guests have left: each once. Dead ones are
  // counted.
  std::vector<ServerId> forget_silent(MonoTime now);
  // Follows the leader's clock.
  void advance(MonoTime now);
  // Whom to ask for the time now; when again, questions_due() says.
  std::vector<ServerId> ask(MonoTime now);
  MonoTime questions_due() const { return next_question_; }

  // Dead, and may be alone in saying so; silent enough to be dead where another server says so.
  bool is_dead(ServerId server) const;
  bool is_silent(ServerId server, MonoTime now) const;
  ServerId leader() const;
  // Whose clock is the cluster's, and what it shows.
  ServerId followed() const { return followed_ != 0 ? followed_ : leader(); }
  const SessionClock& clock() const { return clock_; }
  bool is_clock_known() const { return leader() == self_ || clock_.is_measured(); }
  // That live, and say how guests reach them.
  wire::ServerList addresses() const;

  const std::map<ServerId, Peer>& all() const { return peers_; }
  std::uint64_t deaths() const { return deaths_; }

 private:
  ServerId self_;
  std::int64_t born_us_;
  std::map<ServerId, Peer> peers_;
  FixedList<ServerId, 64> forgotten_;  // the newest of them
  SessionClock clock_;
  ServerId followed_ = 0;
  MonoTime next_question_;
  std::uint64_t deaths_ = 0;
};

}  // namespace dance
