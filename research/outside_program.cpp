#include "research/outside_program.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/program/child_process.h"

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

// An hour of music takes aubio half a minute.
constexpr Duration kTimeout = Duration::s(300);

std::uintmax_t size_of(const std::string& file) {
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file, missing);
  return missing ? 0 : size;
}

// What it said before it ended, if it said anything; the file may have more, of who spoke before
// it.
std::string last_words(const std::string& talk_file, std::uintmax_t begin) {
  constexpr std::size_t kMostLetters = 200;
  std::ifstream talk(talk_file);
  talk.seekg(static_cast<std::streamoff>(begin));
  std::string last;
  for (std::string line; std::getline(talk, line);)
    if (!line.empty()) last = line.substr(0, kMostLetters);
  return last.empty() ? "" : ": " + last;
}

}  // namespace

Result<void> run_outside_program(const OutsideProgram& wanted) {
  const std::string program = find_program(wanted.name);
  if (program.empty())
    return fail(wanted.name + " is not installed: apt-get install " + wanted.package);
  const std::uintmax_t said_before = size_of(wanted.talk_file);
  DANCE_TRY(ChildProcess child, ChildProcess::start({.program = program,
                                                     .arguments = wanted.arguments,
                                                     .output_file = wanted.output_file,
                                                     .talk_file = wanted.talk_file}));
  if (!child.wait(kTimeout)) return fail(wanted.name + " did not come to an end");
  if (!child.ended_well())
    return fail(wanted.name + ": " + child.exit_text() + last_words(wanted.talk_file, said_before));
  return {};
}

}  // namespace dance
