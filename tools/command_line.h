// How the programs of this folder read their command line and talk: a wrong option is one line and exit 2, help ends
// with worked examples, talk goes to stderr because stdout is data.
//
// Threads: call from main, before others are started.
// Failure: parse_command_line() returns the exit code where the program has to end.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace dance {

constexpr int kExitFine = 0;
constexpr int kExitWorld = 1;
constexpr int kExitWrongUse = 2;

// spdlog to stderr, each line beginning with the program's name ("dance record").
void talk_on_stderr(const std::string& program);

// nullopt: go on. Otherwise the program has printed what was asked for, or one line on what is wrong.
std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv);

// Says the error in one line and gives the exit code for it.
int end_with(const Error& error);

}  // namespace dance
