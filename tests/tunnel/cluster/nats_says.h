// What each of the two connections to NATS says: the one for messages, and the one for values.
//
// Ownership: plain functions.
// Threads:   none inside.
// Failure:   the error's line; "connected" where there is none.
#pragma once

#include <string>

#include "tunnel/nats/nats_bus.h"
#include "tunnel/nats/nats_connector.h"

namespace dance {

inline std::string messages_say(const NatsOptions& of) {
  const auto made = NatsConnector(of, *WakeEvent::create()).connect_now();
  return made ? "connected" : made.error().what;
}
inline std::string values_say(NatsOptions of, Poller& poller) {
  of.only_values = true;
  const auto made = NatsBus::connect(of, poller);
  return made ? "connected" : made.error().what;
}

}  // namespace dance
