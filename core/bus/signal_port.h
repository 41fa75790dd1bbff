// SignalPort: where a part of a house publishes messages and subscribes to those of others, of any
// type in core/bus/message_table.h. A bus is one; a house in one process is another
// (house/house_port.h), whose parts hear each other without a bus between them. Manager, link and
// producers do not know which of the two they have.
//
// Units/frames: as in core/pose; stamps in the house's clock.
// Ownership:    handlers, and what they refer to, must outlive the port.
// Threads:      one.
// Failure:      counted, by cause.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "core/base/assert.h"
#include "core/bus/subscription.h"

namespace dance {

class SignalPort {
 public:
  template <class T>
  using Handler = typename TypedSubscription<T>::Handler;
  using Counters = SignalCounters;

  virtual ~SignalPort() = default;
  // The channel must be one of T's signal.
  template <BusMessage T>
  void publish(const Channel& channel, const T& message) {
    DANCE_ASSERT(channel.signal() == MessageTraits<T>::kSignal, channel.signal());
    send(channel, AnyMessage(message));
  }
  template <BusMessage T>
  void publish(Where where, const GuestId& guest, const T& message) {
    publish(Channel::of(MessageTraits<T>::kSignal, where, guest), message);
  }
  // As subscribe<Beat>(Where::kLocal, handler), subscribe<Pose>({Where::kStage, guest}, handler).
  template <BusMessage T>
  void subscribe(const From& from, Handler<T> handler, Delivery delivery = Delivery::kEvery) {
    add(std::make_shared<TypedSubscription<T>>(from, std::move(handler), delivery));
  }
  virtual const Counters& counters() const = 0;

  // What publish() and subscribe() are made of.
  virtual void send(const Channel& channel, const AnyMessage& message) = 0;
  virtual void add(std::shared_ptr<Subscription> subscription) = 0;
};

}  // namespace dance
