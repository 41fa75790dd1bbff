// Which server of a cluster a link speaks to: the nearest when it comes, and another when that one
// ends or falls silent.
//
// Units/frames: MonoTime of the link's clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      of a server that stands alone there is no other: next() gives nothing.
#pragma once

#include <optional>
#include <vector>

#include "core/net/address.h"
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

  // What was measured: puts the others in order, and gives one that is nearer by so much that it is
  // worth to go there. Once, and once more after a lapse that ended at another server: who dances
  // does not wander.
  std::optional<Address> choose(const std::vector<Distance>& distances);

  // The current one was gone to by choice: it has as long as a try has before another is looked
  // for.
  void begin_try(MonoTime now);
  // While the server is silent or has said goodbye: where to go now; nothing = wait on.
  std::optional<Address> next(bool has_goodbye, MonoTime now);
  // The server is heard. True where it is another than before the lapse: a nearer one may be back.
  bool end_lapse();
  // When next() is due again; MonoTime() = not in a lapse.
  MonoTime next_deadline() const { return next_move_; }

 private:
  Duration time_for(const Address& server) const;

  Address current_;
  std::vector<Distance> distances_;  // as measured last
  std::vector<Address> others_;      // the nearest first; those that were tried go to the end
  bool has_chosen_ = false;
  bool has_moved_ = false;  // in this lapse
  MonoTime lapsed_since_;
  MonoTime next_move_;
  MonoTime trying_until_;
  std::size_t tries_ = 0;  // in this lapse
};

}  // namespace dance
