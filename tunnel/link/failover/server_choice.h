// ServerChoice chooses the server of a cluster that a link uses: the nearest one after it has
// connected, and another when that one ends or falls silent.
//
// Units/frames: MonoTime of the link's clock.
// Failure:      next() returns nothing while ServerCandidates allows no other server.
#pragma once

#include <optional>
#include <vector>

#include "core/net/address.h"
#include "tunnel/link/failover/server_candidates.h"
#include "tunnel/wire/wire_servers.h"

namespace dance {

class ServerChoice {
 public:
  struct Distance {
    Address server;
    std::optional<Duration> round_trip;  // nothing: it did not answer
  };

  // The one that is spoken to, and the others that it names.
  void set_current(const Address& server) { current_ = server; }
  const Address& current() const { return current_; }
  // True where they have changed: their distances are to be measured.
  bool set_others(const wire::ServerList& others);
  bool has_others() const { return !others_.empty(); }
  // All that there are, the current one first.
  std::vector<Address> all() const;

  // Sorts the others by distance. A server without a new round trip keeps its last one.
  void set_distances(const std::vector<Distance>& distances);
  // After set_distances(): the nearest server, if moving there is worth the interruption. Returns
  // one once, and once more after a lapse that ended at another server.
  std::optional<Address> choose();

  // The link moves to this server, as choose() suggested. It has the time of a try before next()
  // looks for another.
  void begin_try(const Address& server, MonoTime now);
  // The server to connect to when the current one is silent or has ended; nullopt = wait.
  // Counts a try of the server that it returns.
  std::optional<Address> next(bool has_goodbye, ServerCandidates& candidates, MonoTime now);
  bool is_in_lapse() const { return lapsed_since_.is_set(); }
  // The server answers. Returns true if the link changed its server in this lapse: a nearer server
  // may be back.
  bool end_lapse();
  // When next() is due again; MonoTime() = not in a lapse.
  MonoTime next_deadline() const { return next_move_; }

 private:
  void make_current(const Address& server);
  std::optional<Duration> distance_of(const Address& server) const;
  Duration time_for(const Address& server) const;

  Address current_;
  std::vector<Distance> distances_;  // the newest of each server
  std::vector<Address> others_;      // the nearest first; those that were tried go to the end
  bool has_chosen_ = false;
  bool has_moved_ = false;  // in this lapse
  MonoTime lapsed_since_;
  MonoTime next_move_;
  MonoTime trying_until_;
  std::size_t tries_ = 0;  // in this lapse
};

}  // namespace dance
