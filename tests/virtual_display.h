// An X server without a screen, for tests of windows: ends with the test.
//
// Failure:   display() is empty where there is no Xvfb: skip, with kNoVirtualDisplay.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>

#include "core/program/child_process.h"

namespace dance {

constexpr const char* kNoVirtualDisplay = "no Xvfb here; apt-get install xvfb";

class VirtualDisplay {
 public:
  // With a folder, what is on the screen lies there as Xvfb_screen0, an X window dump.
  explicit VirtualDisplay(const std::string& screen_folder = "",
                          const std::string& screen = "800x600x24") {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return;
    ChildProcess::Options server;
    server.program = "Xvfb";
    server.arguments = {"-displayfd", std::to_string(ends[1]),
                        "-screen",    "0",
                        screen,       "-nolisten",
                        "tcp",        "+extension",
                        "GLX",        "-noreset"};
    if (!screen_folder.empty())
      server.arguments.insert(server.arguments.end(), {"-fbdir", screen_folder});
    if (auto started = ChildProcess::start(server)) server_.emplace(std::move(*started));
    ::close(ends[1]);
    // The number and its end of line come in two writes.
    std::string number;
    pollfd readable{ends[0], POLLIN, 0};
    for (char c = 0; c != '\n' && ::poll(&readable, 1, 20'000) == 1;) {
      if (::read(ends[0], &c, 1) != 1) break;
      if (c == '\n')
        display_ = ":" + number;
      else
        number += c;
    }
    ::close(ends[0]);
  }
  ~VirtualDisplay() {
    // Xvfb handles a signal only before it waits, for minutes: one that arrives in between is seen
    // at the next.
    constexpr int kAsks = 100;
    for (int i = 0; server_ && i < kAsks; ++i) {
      server_->ask_to_stop();
      if (server_->wait(Duration::ms(50))) return;
    }
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  const std::string& display() const { return display_; }

 private:
  std::optional<ChildProcess> server_;
  std::string display_;
};

}  // namespace dance
