#include "apps/key/secret_prompt.h"

#include <unistd.h>

#include "core/base/assert.h"

namespace dance {
namespace {

// What the handler reads: written before it can be called.
termios shown_mode;
bool is_hidden = false;

// Only calls that are safe in a handler.
void show_and_end(int signal) {
  tcsetattr(STDIN_FILENO, TCSANOW, &shown_mode);
  _exit(128 + signal);
}

}  // namespace

SecretPrompt::SecretPrompt() {
  DANCE_ASSERT(!is_hidden);
  is_terminal_ = tcgetattr(STDIN_FILENO, &shown_mode) == 0;
  if (!is_terminal_) return;
  is_hidden = true;
  struct sigaction action {};
  action.sa_handler = show_and_end;
  sigfillset(&action.sa_mask);  // SIGTTOU too: nothing stops the handler half way
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &actions_[i]);
    if (actions_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
  termios quiet = shown_mode;
  quiet.c_lflag &= ~static_cast<tcflag_t>(ECHO);
  // Ctrl-Z would leave a shell without echo, or show the key when the program goes on.
  quiet.c_cc[VSUSP] = _POSIX_VDISABLE;
  tcsetattr(STDIN_FILENO, TCSANOW, &quiet);
}

SecretPrompt::~SecretPrompt() {
  if (!is_terminal_) return;
  tcsetattr(STDIN_FILENO, TCSANOW, &shown_mode);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &actions_[i], nullptr);
  is_hidden = false;
}

}  // namespace dance
