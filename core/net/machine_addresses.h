// The addresses at which this machine is reached from its own network.
//
// Units/frames: as text, without a port.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none are found: an empty list.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/net/address.h"

namespace dance {

// Of networks that are up, without loopback and link-local ones; IPv4 first. At most 16.
std::vector<std::string> machine_addresses();
// Whether it belongs to a home's or an office's own network (or is this machine's), as text
// without a port: 192.168.1.7, fd00::1. Others come from elsewhere.
bool is_private_address(const std::string& address);

// The network device that has an address: "eth0"; "" where none has.
std::string device_of(const Address& address);
// The device over which datagrams to a host leave, by the routes of now; "" without a route. Sends
// nothing.
std::string device_towards(const Address& host);
// The router of the default route of IPv4; not set without one.
Address default_router();
// The same, read from a table in the format of /proc/net/route.
Address router_in(std::string_view route_table);
// True if a route forbids datagrams to this host, as the kill switch of a VPN does.
bool is_route_forbidden(const Address& host);
// True if a program of this machine receives at this port of 127.0.0.1.
bool is_udp_port_taken(std::uint16_t port);
// Whether 127.0.0.1 can be used: its device is up and has it.
struct Loopback {
  bool is_up = false;
  bool has_address = false;
};
Loopback loopback_state();

}  // namespace dance
