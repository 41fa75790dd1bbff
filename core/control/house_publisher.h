// HousePublisher: the port of a program beside a house. What goes to houses is sent over their
// socket; all but requests goes over the bus as well, for displays and recorders.
//
// Units/frames: as on the bus.
// Ownership:    refers to bus and poller, which must outlive it.
// Threads:      the poller's.
// Failure:      none of its own; the bus counts.
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "core/bus/signal_port.h"
#include "core/control/house_socket.h"

namespace dance {

class HousePublisher final : public SignalPort {
 public:
  HousePublisher(SignalPort& bus, std::string_view bus_url, Poller& poller)
      : bus_(bus), houses_(bus_url, poller) {}

  // The bus first: displays are there.
  void send(const Channel& channel, const AnyMessage& message) override {
    const Signal signal = channel.signal();
    if (!is_request(signal, channel.where())) bus_.send(channel, message);
    if (goes_to_house(signal, channel.where())) houses_.send(channel, message);
  }
  void add(std::shared_ptr<Subscription> subscription) override {
    bus_.add(std::move(subscription));
  }
  const Counters& counters() const override { return bus_.counters(); }
  HouseSender& houses() { return houses_; }

 private:
  SignalPort& bus_;
  HouseSender houses_;
};

}  // namespace dance
