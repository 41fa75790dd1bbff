// Interface between the tunnel's state machines and the transport of their datagrams (a socket, a
// batch, a simulated network in tests, a DTLS session).
//
// Units/frames: bytes.
// Ownership:    send() copies or passes on the bytes before it returns.
// Threads:      the caller's.
// Failure:      none here; the transport counts what could not be sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/net/address.h"

namespace dance {

// Headers of IPv4 and UDP of each datagram.
constexpr std::size_t kIpUdp_bytes = 28;

class DatagramSink {
 public:
  virtual ~DatagramSink() = default;
  virtual void send(const Address& to, std::span<const std::uint8_t> bytes) = 0;
};

}  // namespace dance
