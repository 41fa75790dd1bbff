// The options that describe an emulated line, the same for every program that has one.
//
// Units/frames: none.
// Ownership:    the words are the caller's and must outlive parsing.
// Threads:      none inside.
// Failure:      a word of a link that is not known is wrong use; files are read later, by
//               load_line().
#pragma once

#include <string>
#include <vector>

#include "core/program/command_line.h"
#include "testing/line/lossy_line.h"

namespace dance {

constexpr const char* kTraceHelp =
    "recorded line (.csv of t_ms or t_s with owd_var_ms or rtt_ms, or mahimahi's milliseconds; or "
    ".xz of it); comes on top of --link";

void add_link_options(CommandLine& line, LineWords& words);
void add_trace_options(CommandLine& line, LineWords& words);

// The same words for another program.
std::vector<std::string> line_arguments(const LineWords& words);

}  // namespace dance
