// What every program of the tree does alike: options by CLI11, talk on stderr, one line for what went wrong, and the
// exit code: 0 fine, 1 the world, 2 wrong use.
//
// Ownership: refers to the app for the length of the call.
// Threads:   call from main.
// Failure:   run_program() prints the Error's one line and returns 1.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "core/base/result.h"

namespace dance {

// Parses the command line and runs `body`. A wrong option is one line on stderr and 2.
int run_program(CLI::App& app, int argc, char** argv, const std::function<Result<void>()>& body);

// The folder that this program lies in, where its sisters are.
std::string program_folder();

}  // namespace dance
