// Reads a server's status on this machine, through the socket that it opens for its user.
//
// Units/frames: the answer is the JSON of tunnel/server/program/server_status.h.
// Ownership:    plain values.
// Threads:      any; waits up to two seconds.
// Failure:      one line that tells no server, another user's server and a silent one apart, each
//               with its cure.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace dance {

Result<nlohmann::ordered_json> ask_server(std::uint16_t port);

// The user whose program has a UDP port, by a table as in /proc/net/udp and /proc/net/udp6.
std::optional<uid_t> owner_of_udp_port(std::string_view table, std::uint16_t port);

}  // namespace dance
