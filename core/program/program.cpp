#include "core/program/program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/base/text/plain_text.h"
#include "core/program/talk.h"

namespace dance {

int run_program(CommandLine& line, int argc, char** argv,
                const std::function<Result<void>()>& body) {
  // Recordings, settings, keys and reports are private. The mask also covers what libraries and
  // child programs create.
  ::umask(0077);
  // A limit on file sizes is an error of write(), not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  const std::string name = line.name();
  switch (line.parse(argc, argv)) {
    case CommandLine::Parsed::kHelp:
      std::fputs(line.text().c_str(), stdout);
      return 0;
    case CommandLine::Parsed::kWrong:
      std::fprintf(stderr, "%s: %s; %s --help lists the options\n", name.c_str(),
                   plain_text(line.text()).c_str(), name.c_str());
      return 2;
    case CommandLine::Parsed::kRun:
      break;
  }
  // stdout is data, stderr is messages.
  talk::begin(name);

  const Result<void> result = body();
  if (result) return 0;
  std::fprintf(stderr, "%s: %s\n", name.c_str(), plain_text(result.error().what).c_str());
  return 1;
}

std::string program_folder() {
  std::array<char, PATH_MAX> path{};
  const auto size = readlink("/proc/self/exe", path.data(), path.size() - 1);
  return size > 0 ? std::filesystem::path(path.data()).parent_path().string() : ".";
}

std::string data_folder() {
  return (std::filesystem::path(program_folder()).parent_path() / "share/dancegraph").string();
}

std::string display_name() {
  for (const char* variable : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): at start
    if (value && *value) return value;
  }
  return "";
}

}  // namespace dance
