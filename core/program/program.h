// What every program needs: options, messages on stderr, one line for an error, and the exit code:
// 0 success, 1 the environment, 2 wrong use.
//
// Ownership: refers to the command line for the length of the call.
// Threads:   call from main.
// Failure:   run_program() prints the Error's one line and returns 1.
#pragma once

#include <functional>
#include <string>

#include "core/base/result.h"
#include "core/program/command_line.h"

namespace dance {

// Parses the command line and runs `body`. A wrong option is one line on stderr and 2. Errors are
// printed as plain text (core/base/text/plain_text.h). All files that the program and its children
// create are for its user alone: files 0600, folders 0700. A file that exists keeps its mode.
int run_program(CommandLine& line, int argc, char** argv,
                const std::function<Result<void>()>& body);

// The folder of this program and all others of the build or the installation.
std::string program_folder();

// share/dancegraph beside that folder: files that programs read, in a build and in an installation.
std::string data_folder();

// The display for windows, by DISPLAY or WAYLAND_DISPLAY; "" without one.
std::string display_name();

}  // namespace dance
