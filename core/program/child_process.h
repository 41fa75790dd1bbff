// ChildProcess: another program, or a copy of this process, that ends when this process ends,
// however that ends. The only place that forks and that sends signals: a signal never goes to -1
// (every process of the user), to 0 (our own group) or to init.
//
// Ownership: owns the process: the destructor sends SIGTERM and, if needed, SIGKILL.
// Failure:   start() names the program and the reason.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

// Processor time of a process so far, also of another user's; nothing where there is none.
std::optional<Duration> cpu_time_of(pid_t process);

// Sends a signal to one process, as kill() does; 0 only asks whether it can be signalled. False
// where there is no such process, it is another user's, or `process` is 1 or less.
bool send_signal(pid_t process, int signal);

// True if the shell finds a program of that name.
bool is_in_path(const std::string& program);

class ChildProcess {
 public:
  struct Options {
    std::string program;  // path; a name without '/' is searched in PATH
    std::vector<std::string> arguments{};
    std::string output_file{};  // where its stdout goes; "" = ours
    std::string talk_file{};    // where its stderr goes; "" = ours
    int talk_fd = -1;           // or a descriptor of ours, as of a pipe
    int output_fd = -1;         // so for its stdout
    int input_fd = -1;          // its stdin; -1 = ours
    int terminal_fd = -1;       // its controlling terminal, and stdin, stdout and stderr
  };

  static Result<ChildProcess> start(const Options& options);
  // A copy of this process, which calls `body` and ends with its result as the exit code. For work
  // that must not run in this process; `body` may only use calls that are safe after fork().
  static Result<ChildProcess> start_copy(const std::function<int()>& body);
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  pid_t pid() const { return pid_; }
  // Processor time so far; 0 once it has ended.
  Duration cpu_time() const;
  // True once the process has ended; then exit_text() says how.
  bool has_ended();
  const std::string& exit_text() const { return exit_text_; }
  bool ended_well() const { return exit_code_ == 0; }
  // Of one that has ended by itself; -1 while it runs, and for one that a signal ended.
  int exit_code() const { return exit_code_; }
  // The signal that ended it; 0 while it runs, and for one that ended by itself.
  int end_signal() const { return end_signal_; }

  // Waits up to `timeout` for it to end by itself; true where it has.
  bool wait(Duration timeout);
  // False where it has ended.
  bool send_signal(int signal);
  void ask_to_stop();
  // Waits up to `timeout` for it to end, then kills it.
  void stop(Duration timeout);
  // Kills it at once, and waits until it is gone.
  void kill_now();

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  void note_end(int status);

  pid_t pid_ = -1;
  bool ended_ = false;
  int exit_code_ = -1;
  int end_signal_ = 0;
  std::string exit_text_;
};

}  // namespace dance
