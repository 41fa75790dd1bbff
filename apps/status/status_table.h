// A server's status as two tables for a terminal: rooms, and who is in them. Below them what was
// refused, where anything was.
//
// Units/frames: the JSON of tunnel/server/program/server_status.h; what it does not say is a dash.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      what is missing or of another kind is shown as a dash, odd characters as '?'.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace dance {

std::string status_text(const nlohmann::ordered_json& status);

}  // namespace dance
