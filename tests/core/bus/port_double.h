// PortDouble: a SignalPort without a bus. What is published is noted, encoded, and heard by its
// subscribers.
//
// Ownership: keeps the subscriptions and what was sent.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/bus/signal_port.h"

namespace dance {

class PortDouble : public SignalPort {
 public:
  void send(const Channel& channel, const AnyMessage& message) override {
    sent.emplace_back(channel.view());
    // A subscriber may send.
    MessageBuffer encoded;
    const std::size_t encoded_size = size = message.encode(encoded);
    bytes = encoded;
    for (const auto& subscription : subscriptions)
      if (subscription->signal() == channel.signal() && subscription->from().includes(channel))
        subscription->take({channel.view(), encoded.data(), encoded_size, now}, counted);
  }
  void add(std::shared_ptr<Subscription> subscription) override {
    subscriptions.push_back(std::move(subscription));
  }
  const Counters& counters() const override { return counted; }

  MonoTime now;  // when subscribers receive what is published
  std::vector<std::string> sent;
  MessageBuffer bytes;  // of the last
  std::size_t size = 0;
  std::vector<std::shared_ptr<Subscription>> subscriptions;
  Counters counted;
};

}  // namespace dance
