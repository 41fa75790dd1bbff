#include "core/program/program.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstdio>
#include <filesystem>

namespace dance {

int run_program(CLI::App& app, int argc, char** argv, const std::function<Result<void>()>& body) {
  app.set_help_flag("-h,--help", "print this and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success&) {  // --help
    std::fputs(app.help().c_str(), stdout);
    return 0;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s: %s; %s --help lists the options\n", app.get_name().c_str(),
                 error.what(), app.get_name().c_str());
    return 2;
  }
  // stdout is data, stderr is talk.
  auto logger = spdlog::stderr_logger_st(app.get_name());
  logger->set_pattern("%H:%M:%S.%e %n: %v");
  spdlog::set_default_logger(logger);

  const Result<void> result = body();
  if (result) return 0;
  std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), result.error().what.c_str());
  return 1;
}

std::string program_folder() {
  std::array<char, PATH_MAX> path{};
  const auto size = readlink("/proc/self/exe", path.data(), path.size() - 1);
  return size > 0 ? std::filesystem::path(path.data()).parent_path().string() : ".";
}

}  // namespace dance
