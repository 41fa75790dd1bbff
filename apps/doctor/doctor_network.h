// Checks of the network: loopback, the ports of inputs, the route to the internet, the resolver of
// names, and the addresses of the servers that run here.
//
// Threads:   call from main; waits some seconds at most. Nothing is sent but the lookup of a name.
// Failure:   a check that cannot read the system's state returns no finding.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/doctor/doctor_checks.h"
#include "core/net/machine_addresses.h"
#include "core/net/names/name_lookup.h"

namespace dance {

Finding check_loopback(const Loopback& loopback);

// True if a device belongs to a tunnel: WireGuard, OpenVPN and others.
bool is_vpn_device(const std::string& device, const std::string& devices = "/sys/class/net");
// Judges the device of the default route; "" means no route.
Finding check_internet_route(const std::string& device, bool is_vpn);
// The finding if a route forbids the internet.
Finding check_forbidden_route();

// Judges ::1, to which programs of others may send.
Finding check_ipv6_loopback(bool has_address);

// The ports at which `dance receive` waits for other programs, with their protocols.
struct InputPort {
  std::string protocol;
  std::uint16_t port = 0;
};
std::vector<InputPort> usual_input_ports();
// Judges those that are taken.
Finding check_input_ports(const std::vector<InputPort>& taken);

// The host name in a session file's `server`; "" if it is an address or empty.
std::string host_name_of(const std::string& server);

// Judges a lookup of the server's name, or of one that no nameserver knows (kNoSuchName).
constexpr const char* kNoSuchName = "dancegraph.invalid";
Finding check_names(const ResolverAnswer& lookup, bool has_nameserver);

// Judges the address of a server on this machine, as `dance status` shows it.
Finding check_server_reach(const std::string& address, const std::vector<std::string>& machine);

std::vector<Finding> examine_network();

}  // namespace dance
