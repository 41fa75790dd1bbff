// The audit log of a server as a table for a terminal, or as JSON: the newest entry last.
//
// Failure: lines that are no entries are left out; a last line of the table counts them.
#pragma once

#include <string>
#include <string_view>

namespace dance {

// The lines have the format of tunnel/server/program/audit_log.h.
std::string log_text(std::string_view lines);
std::string log_json(std::string_view lines);

}  // namespace dance
