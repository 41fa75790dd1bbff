// ChildProcess: runs another program of the tree, for the demo and the house. It ends when this
// process ends, however that ends.
//
// Units/frames: none; times as Duration.
// Ownership:    owns the process: the destructor sends SIGTERM and, if needed, SIGKILL.
// Threads:      one.
// Failure:      start() names the program and the reason.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

// Processor time of a process so far, also of another user's; nothing where there is none.
std::optional<Duration> cpu_time_of(pid_t process);

class ChildProcess {
 public:
  struct Options {
    std::string program;  // path
    std::vector<std::string> arguments;
    std::string output_file;  // where its stdout goes; "" = ours
    std::string talk_file;    // where its stderr goes; "" = ours
    int talk_fd = -1;         // or a descriptor of ours, as of a pipe
    int output_fd = -1;       // so for its stdout
  };

  static Result<ChildProcess> start(const Options& options);
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

  // Waits up to `timeout` for it to end by itself; true where it has.
  bool wait(Duration timeout);
  void ask_to_stop();
  // Waits up to `timeout` for it to end, then kills it.
  void stop(Duration timeout);

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  void note_end(int status);

  pid_t pid_ = -1;
  bool ended_ = false;
  int exit_code_ = -1;
  std::string exit_text_;
};

}  // namespace dance
