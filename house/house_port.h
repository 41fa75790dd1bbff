// HousePort: the port of a house in one process. Its parts (link, manager, hosted producers and
// consumers) hear each other at once, without a bus between them; everything goes over the bus as
// well, for the programs beside the house, and what those say comes from there.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the bus, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      none of its own; the bus counts.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/bus/signal_port.h"
#include "core/control/house_inputs.h"

namespace dance {

// Which channels this process publishes itself: their copies that come back over the bus are not
// delivered again. The stage's are always its own.
struct HostedParts {
  bool has_link = false;           // publishes what comes from other houses
  std::vector<GuestId> producers;  // publish poses, hands and proportions of these guests
};

class HousePort final : public SignalPort {
 public:
  HousePort(SignalPort& bus, HostedParts hosted) : bus_(bus), hosted_(std::move(hosted)) {}

  // Takes what this port publishes, and how guests are to be shown; it must outlive the port's use.
  void attach(HouseInputs& inputs) { inputs_ = &inputs; }

  void send(const Channel& channel, const AnyMessage& message) override;
  void add(std::shared_ptr<Subscription> subscription) override;
  const Counters& counters() const override { return bus_.counters(); }

 private:
  bool is_hosted(Signal signal, Where where, const GuestId& guest) const;

  SignalPort& bus_;
  HouseInputs* inputs_ = nullptr;
  HostedParts hosted_;
  std::vector<std::shared_ptr<Subscription>> subscriptions_;
};

}  // namespace dance
