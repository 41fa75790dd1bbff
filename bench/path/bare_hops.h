// Bare hops: the least that a process between two wires can do, one blocking call in and one call
// out. A pose's journey is measured against them, so LCM and sockets are used as they are, without
// this tree's classes. A bus is LCM's library, or a multicast socket over lo with nothing above it.
//
// Ownership: a hop runs until a signal ends its process; descriptors are the caller's.
// Threads:   the caller's (and LCM's own).
// Failure:   a hop returns only after an error, and returns that error.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace dance {

// Forwards each message of `channel` on the bus as one datagram to 127.0.0.1:to_port.
Error forward_bus_to_udp(const std::string& bus_url, const std::string& channel,
                         std::uint16_t to_port);
// Forwards each datagram on 127.0.0.1:from_port to 127.0.0.1:to_port.
Error forward_udp_to_udp(std::uint16_t from_port, std::uint16_t to_port);
// Forwards each datagram on 127.0.0.1:from_port as a message of `channel` on the bus.
Error forward_udp_to_bus(std::uint16_t from_port, const std::string& bus_url,
                         const std::string& channel);

// The same two with a multicast group of this machine in place of the bus.
Error forward_group_to_udp(std::uint16_t group_port, std::uint16_t to_port);
Error forward_udp_to_group(std::uint16_t from_port, std::uint16_t group_port);

// Open sockets of that group: one that receives at the port, one that sends to it. Negative if the
// kernel refuses; errno has the reason.
int open_group_receiver(std::uint16_t port);
int open_group_sender(std::uint16_t port);

}  // namespace dance
