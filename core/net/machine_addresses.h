// The addresses at which this machine is reached from its own network.
//
// Units/frames: as text, without a port.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none are found: an empty list.
#pragma once

#include <string>
#include <vector>

namespace dance {

// Of networks that are up, without loopback and link-local ones; IPv4 first. At most 16.
std::vector<std::string> machine_addresses();
// Whether it belongs to a home's or an office's own network (or is this machine's), as text
// without a port: 192.168.1.7, fd00::1. Others come from elsewhere.
bool is_private_address(const std::string& address);

}  // namespace dance
