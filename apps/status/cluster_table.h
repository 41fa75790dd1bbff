// A server's cluster as tables for a terminal: NATS, the servers, and what passes between this one
// and each other in each room.
//
// Units/frames: the member "cluster" of a server's status; what it does not say is a dash.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      as status_text().
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dance {

std::string cluster_text(const nlohmann::ordered_json& status);

}  // namespace dance
