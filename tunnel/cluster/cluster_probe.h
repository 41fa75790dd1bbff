// Listens to a cluster without being one of its servers: who beats, and what time each has.
//
// Units/frames: offsets are a server's session clock less the clock of `now`; an offset is wrong by
//               half the round trip at most.
// Ownership:    the bus must outlive it; it has the bus's handlers.
// Threads:      the owner's; no call waits.
// Failure:      what is no message is ignored. At most kMost servers.
#pragma once

#include <map>

#include "tunnel/cluster/cluster_bus.h"
#include "tunnel/cluster/cluster_format.h"
#include "tunnel/cluster/cluster_names.h"

namespace dance {

class ClusterProbe {
 public:
  static constexpr std::size_t kMost = 256;
  struct Seen {
    cluster::Heartbeat beat;
    std::size_t answers = 0;
    Duration offset;  // of the answer with the shortest round trip
    Duration round_trip;
  };

  // `id` is nobody else's.
  ClusterProbe(ServerId id, ClusterBus& bus);
  // Asks all that beat for the time; returns when to call again.
  MonoTime tick(MonoTime now);
  const std::map<ServerId, Seen>& seen() const { return seen_; }

 private:
  void on_message(cluster::Bytes bytes, MonoTime now);

  ServerId id_;
  ClusterBus& bus_;
  std::map<ServerId, Seen> seen_;
};

}  // namespace dance
