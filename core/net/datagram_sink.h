// Where datagrams go: the seam between the tunnel's state machines and what carries their datagrams
// (a socket, a batch, a simulated network in tests, a sealed session).
//
// Ownership: send() copies or passes on the bytes before it returns.
// Threads:   the caller's.
// Failure:   none here; whoever carries counts what could not be sent.
#pragma once

#include <cstdint>
#include <span>

#include "core/net/address.h"

namespace dance {

class DatagramSink {
 public:
  virtual ~DatagramSink() = default;
  virtual void send(const Address& to, std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace dance
