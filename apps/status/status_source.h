// Reads a server's status and its audit log on this machine, through the sockets that it opens for
// its user.
//
// Units/frames: the status is the JSON of tunnel/server/program/server_status.h; the log has one
//               line of tunnel/server/program/audit_log.h for each entry.
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
Result<std::string> ask_server_log(std::uint16_t port);

// The user whose program has a UDP port, by a table as in /proc/net/udp and /proc/net/udp6.
std::optional<uid_t> owner_of_udp_port(std::string_view table, std::uint16_t port);

}  // namespace dance
