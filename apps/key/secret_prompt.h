// Turns the terminal's echo off while this lives and on again afterwards, also where a signal ends
// the program meanwhile.
//
// Ownership: the terminal's echo, and what SIGINT, SIGQUIT, SIGTERM and SIGHUP do. One at a time. A
//            signal that was ignored before (nohup) stays so.
// Threads:   one.
// Failure:   where standard input is no terminal it does nothing. One of these signals ends the
//            program at once, with 128 and its number, as a shell would say it.
#pragma once

#include <termios.h>

#include <array>
#include <csignal>

namespace dance {

class SecretPrompt {
 public:
  SecretPrompt();
  ~SecretPrompt();
  SecretPrompt(const SecretPrompt&) = delete;
  SecretPrompt& operator=(const SecretPrompt&) = delete;

 private:
  static constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};

  bool is_terminal_ = false;
  std::array<struct sigaction, kSignals.size()> actions_{};  // before
};

}  // namespace dance
