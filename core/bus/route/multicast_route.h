// Finds the network device that carries multicast. Our own programs need no route
// (core/bus/bus_socket.h), but LCM's programs cannot open a bus without one, and one over a real
// network card fails when its cable is pulled.
//
// Failure: without a route, or without the kernel's table, there is no device.
#pragma once

#include <string>
#include <string_view>

namespace dance {

// The device of the group's route ("lo" is best), or "" where there is no route. `routes` has the
// format of /proc/net/route.
std::string multicast_device(std::string_view group, std::string_view routes);
std::string multicast_device(std::string_view group);

// The command that adds a route.
constexpr const char* kMulticastCure = "ip route add 224.0.0.0/4 dev lo";

}  // namespace dance
