// Programs of the build, run by tests as a user runs them, and waits for what they do: up to a
// timeout that no machine should need, and no longer than it takes.
//
// Ownership: values.
// Threads:   any; each run() has its own folder only where one runs at a time in a process.
// Failure:   what cannot be started has the exit code -1 or 127.
#pragma once

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "tests/test_folder.h"

namespace dance {

inline std::string bin(const std::string& program) { return DANCE_BINARY_DIR "/bin/" + program; }

struct Finished {
  int exit_code = -1;
  std::string output;  // stdout
  std::string talk;    // stderr
};

// Runs a shell's command line to its end.
inline Finished run(const std::string& command) {
  const TestFolder folder("run");
  Finished finished;
  FILE* pipe = popen(("{ " + command + "\n} 2>" + folder.path("talk")).c_str(), "r");
  if (!pipe) return finished;
  std::array<char, 4096> chunk;
  for (std::size_t n; (n = fread(chunk.data(), 1, chunk.size(), pipe)) > 0;)
    finished.output.append(chunk.data(), n);
  finished.exit_code = WEXITSTATUS(pclose(pipe));
  finished.talk = text_of(folder.path("talk"));
  return finished;
}

constexpr std::chrono::seconds kTimeout{60};

// Whether the condition came to hold.
template <class Condition>
bool wait_for(const Condition& condition, std::chrono::seconds timeout = kTimeout) {
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  while (!condition()) {
    if (std::chrono::steady_clock::now() >= give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

// Runs it again until it is as wanted, which takes a while where others must come up first; the
// last run.
template <class Condition>
Finished run_until(const std::string& command, const Condition& is_as_wanted) {
  Finished finished;
  wait_for([&] { return is_as_wanted(finished = run(command)); });
  return finished;
}

}  // namespace dance
