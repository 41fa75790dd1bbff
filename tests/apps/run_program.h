// Programs of the build, run by tests as a user runs them, and waits for what they do: up to a
// patience that no machine should need, and no longer than it takes.
//
// Ownership: a TestFolder and what is in it go with the object.
// Threads:   any; each run() has its own folder only where one runs at a time in a process.
// Failure:   what cannot be started has the exit code -1 or 127.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace dance {

inline std::string bin(const std::string& program) { return DANCE_BINARY_DIR "/bin/" + program; }

struct Finished {
  int exit_code = -1;
  std::string output;  // stdout
  std::string talk;    // stderr
};

// An empty folder of this test's own, gone when it ends.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("dance-" + name + "-" + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string path(const std::string& name = "") const {
    return (name.empty() ? path_ : path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

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

constexpr std::chrono::seconds kPatience{60};

// Whether the condition came to hold.
template <class Condition>
bool wait_for(const Condition& condition) {
  const auto give_up = std::chrono::steady_clock::now() + kPatience;
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
