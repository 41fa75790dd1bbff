// Which network device carries a bus's multicast: LCM cannot be opened without a route for its
// group, and a bus that rides on a real network card stops when the cable is pulled.
//
// Threads: any.
// Failure: an unset device means that the kernel has no route; the file of routes missing counts as
//          no route.
#pragma once

#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

struct BusAddress {
  std::string group;  // e.g. 239.255.76.67
  int port = 0;
};

// The group and port of an LCM "udpm://" URL; an error that names what is wrong with it.
Result<BusAddress> parse_udpm_url(std::string_view url);

// The device that the kernel's routes give for the group ("lo" is best), or "" where there is no
// route. `routes` has the format of /proc/net/route.
std::string multicast_device(std::string_view group, std::string_view routes);
std::string multicast_device(std::string_view group);

// The command that mends a machine without a route.
constexpr const char* kMulticastCure = "ip route add 224.0.0.0/4 dev lo";

}  // namespace dance
