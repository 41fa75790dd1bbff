// An X server without a screen, for tests of windows: ends with the test.
//
// Ownership: owns the server's process.
// Threads:   one; begin it before others.
// Failure:   display() is empty where there is no Xvfb: skip, with kNoVirtualDisplay.
#pragma once

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

namespace dance {

constexpr const char* kNoVirtualDisplay = "no Xvfb here; apt-get install xvfb";

class VirtualDisplay {
 public:
  // With a folder, what is on the screen lies there as Xvfb_screen0, an X window dump.
  explicit VirtualDisplay(const std::string& screen_folder = "",
                          const std::string& screen = "800x600x24") {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    const std::string fd = std::to_string(ends[1]);
    std::vector<const char*> words{"Xvfb",       "-displayfd",   fd.c_str(),  "-screen",
                                   "0",          screen.c_str(), "-nolisten", "tcp",
                                   "+extension", "GLX",          "-noreset"};
    if (!screen_folder.empty()) words.insert(words.end(), {"-fbdir", screen_folder.c_str()});
    words.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      close(ends[0]);
      execvp("Xvfb", const_cast<char* const*>(words.data()));
      _exit(127);
    }
    close(ends[1]);
    // The number and its end of line come in two writes.
    std::string number;
    pollfd readable{ends[0], POLLIN, 0};
    for (char c = 0; c != '\n' && poll(&readable, 1, 20'000) == 1;) {
      if (read(ends[0], &c, 1) != 1) break;
      if (c == '\n')
        display_ = ":" + number;
      else
        number += c;
    }
    close(ends[0]);
  }
  ~VirtualDisplay() {
    if (pid_ <= 0) return;
    // It looks at what a signal asked for before it waits, for minutes: one that comes in between
    // is not seen until the next.
    constexpr int kAsks = 100;
    for (int i = 0; waitpid(pid_, nullptr, WNOHANG) == 0; ++i) {
      kill(pid_, i < kAsks ? SIGTERM : SIGKILL);
      poll(nullptr, 0, 50);
    }
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  const std::string& display() const { return display_; }

 private:
  pid_t pid_ = -1;
  std::string display_;
};

}  // namespace dance
