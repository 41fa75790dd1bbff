// How a link stands, as a window is told: HOUSE_LINK/local, made of what the link's handlers are
// called with.
//
// Units/frames: MonoTime of this house's clock.
// Ownership:    plain value; what listen_to() adds to the handlers refers to it.
// Threads:      the link's.
// Failure:      none.
#pragma once

#include <functional>

#include "core/bus/house_messages.h"
#include "tunnel/link/core/link_options.h"

namespace dance {

class LinkStatus {
 public:
  // Adds itself to the handlers, behind what they do already.
  void listen_to(LinkHandlers& handlers);
  // Called at each change.
  void on_change(std::function<void()> on_change) { on_change_ = std::move(on_change); }

  void set_may_remove(bool may_remove) { status_.may_remove = may_remove; }
  const HouseLink& status() const { return status_; }

 private:
  void settle(HouseLinkTrouble trouble);
  void on_state(LinkState state);
  void on_refused(const wire::RefusalNotice& refusal, MonoTime now);
  void on_removal(std::int32_t number, RemovalVerdict verdict);
  void changed() const {
    if (on_change_) on_change_();
  }

  HouseLink status_;
  std::function<void()> on_change_;
};

}  // namespace dance
