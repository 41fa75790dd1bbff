// Bare hops: the least that a process between two wires can do, one blocking call in and one call
// out. What a pose's journey is measured against, so LCM and sockets are used as they are, without
// this tree's classes.
//
// Ownership: each runs until a signal ends its process.
// Threads:   the caller's (and LCM's own).
// Failure:   return only when something is wrong, with what it was.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace dance {

// Each message of `channel` on the bus as one datagram to 127.0.0.1:to_port.
Error forward_bus_to_udp(const std::string& bus_url, const std::string& channel,
                         std::uint16_t to_port);
// Each datagram on 127.0.0.1:from_port to 127.0.0.1:to_port.
Error forward_udp_to_udp(std::uint16_t from_port, std::uint16_t to_port);
// Each datagram on 127.0.0.1:from_port as a message of `channel` on the bus.
Error forward_udp_to_bus(std::uint16_t from_port, const std::string& bus_url,
                         const std::string& channel);

}  // namespace dance
