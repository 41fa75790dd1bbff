#include "tools/command_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>

namespace dance {

void talk_on_stderr(const std::string& program) {
  spdlog::set_default_logger(spdlog::stderr_color_mt(program));
  spdlog::set_pattern("%n: %v");
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return kExitFine;
  } catch (const CLI::ParseError& error) {
    std::string what = error.what();
    for (char& c : what)
      if (c == '\n') c = ' ';
    spdlog::error("{}; `{} --help` shows the options", what, app.get_name());
    return kExitWrongUse;
  }
}

int end_with(const Error& error) {
  spdlog::error("{}", error.what);
  return kExitWorld;
}

}  // namespace dance
