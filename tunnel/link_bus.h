// Puts a link on a house's bus: what this house captures goes to the link, and what the link hears
// of the others goes to POSE/guest/<id> and its like.
//
// Units/frames: as in core/bus; one clock for both.
// Ownership:    bus and link must outlive it; make it before the link, whose handlers it gives.
// Threads:      the poller's.
// Failure:      none of its own; link and bus count.
#pragma once

#include <map>

#include "core/bus/bus.h"
#include "tunnel/link.h"

namespace dance {

class LinkBus {
 public:
  explicit LinkBus(Bus& bus, std::uint64_t clock_id) : bus_(bus), clock_id_(clock_id) {}

  // What the link is to be opened with; on_state, on_refused and the guests' coming and going are
  // the caller's to add.
  LinkHandlers handlers();
  void attach(Link& link) { link_ = &link; }
  // From now on this guest's captures go to the link; everybody's where the guest is not set.
  void send_captures_of(const GuestId& guest);
  void forget(const GuestId& guest) { skeletons_.erase(guest); }
  // STATS/link, and the skeletons of the others again, as who starts late must hear them. Call once
  // a second.
  void publish_second(MonoTime now);

 private:
  Bus& bus_;
  std::uint64_t clock_id_;
  Link* link_ = nullptr;
  std::map<GuestId, Skeleton> skeletons_;
};

}  // namespace dance
