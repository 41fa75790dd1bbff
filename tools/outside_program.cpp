#include "tools/outside_program.h"

#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <thread>

#include "tools/child_process.h"

namespace dance {
namespace {

std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): one thread
  std::istringstream folders(path ? path : "/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::string program = folder + "/" + name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

// Ten times as long as an hour of music takes aubio.
constexpr Duration kPatience = Duration::s(300);

}  // namespace

Result<void> run_outside_program(const OutsideProgram& wanted) {
  const std::string program = find_program(wanted.name);
  if (program.empty())
    return fail(wanted.name + " is not installed: apt-get install " + wanted.package);
  DANCE_TRY(ChildProcess child, ChildProcess::start({.program = program,
                                                     .arguments = wanted.arguments,
                                                     .output_file = wanted.output_file,
                                                     .talk_file = wanted.talk_file}));
  Duration waited;
  for (constexpr auto kTurn = Duration::ms(20); !child.has_ended(); waited += kTurn) {
    if (waited > kPatience) return fail(wanted.name + " did not come to an end");
    std::this_thread::sleep_for(std::chrono::milliseconds(kTurn.count_ms()));
  }
  if (!child.ended_well()) return fail(wanted.name + ": " + child.exit_text());
  return {};
}

}  // namespace dance
