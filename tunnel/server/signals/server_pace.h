// How fast poses go to each receiver. With nothing in the way each goes at once. Where a line does
// not bear that (tunnel/server/pace/line_budget.h), poses wait to share a datagram, and where that
// does not do, the guests of least importance are thinned out. Where the server itself sends
// more than it should, poses wait too.
//
// Importance: those whom the receiver named with all of their poses (`bob=1`) come first, then the
// others by how near their place on the stage is to the nearest of the receiver's own guests.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context. Never allocates.
// Threads:      none inside; one owner.
// Failure:      what a link says of itself in its pings counts for its own line only.
#pragma once

#include "tunnel/server/pace/share_plan.h"
#include "tunnel/server/signals/server_interest.h"

namespace dance {

class ServerPace {
 public:
  ServerPace(ServerContext& server, ServerInterest& interest)
      : server_(server), interest_(interest) {}

  // The session's newest ping is there.
  void on_ping(std::size_t session, MonoTime now);
  // Often enough: measures what guests send, and the server.
  void sample(MonoTime now);

 private:
  struct Ranked {
    std::uint8_t slot = 0;
    bool is_chosen = false;
    float distance_m2 = 0.0f;
    std::uint8_t turn = 0;  // of equals: others are first for each receiver
  };
  struct Wanted {
    std::array<Ranked, wire::kMaxGuestsPerRoom> ranks;
    std::array<WantedFlow, wire::kMaxGuestsPerRoom> flows;
    std::size_t count = 0;
    WantedFlows all() const { return {flows.data(), count}; }
  };

  Wanted wanted_by(std::size_t session) const;
  float distance_m2(const ServerSession& session, const ServerGuest& guest) const;
  void settle(std::size_t session, const Wanted& wanted, MonoTime now);

  ServerContext& server_;
  ServerInterest& interest_;
  MonoTime sampled_;
  std::uint64_t records_out_ = 0;
  double records_per_s_ = 0.0;
};

}  // namespace dance
