#include "core/program/child_process.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <utility>

namespace dance {
namespace {

// In the child: it ends with its parent, and no signal is blocked.
void follow(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);  // the parent died before we could ask
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void become(const ChildProcess::Options& options, char* const* arguments,
                         pid_t parent) {
  follow(parent);
  const auto redirect = [](const std::string& file, int to) {
    if (file.empty()) return;
    const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
    if (fd < 0 || dup2(fd, to) < 0) _exit(126);
  };
  redirect(options.output_file, STDOUT_FILENO);
  redirect(options.talk_file, STDERR_FILENO);
  if (options.talk_fd >= 0 && dup2(options.talk_fd, STDERR_FILENO) < 0) _exit(126);
  if (options.output_fd >= 0 && dup2(options.output_fd, STDOUT_FILENO) < 0) _exit(126);
  if (options.input_fd >= 0 && dup2(options.input_fd, STDIN_FILENO) < 0) _exit(126);
  if (options.terminal_fd >= 0) {
    if (setsid() < 0 || ioctl(options.terminal_fd, TIOCSCTTY, 0) != 0) _exit(126);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      if (dup2(options.terminal_fd, fd) < 0) _exit(126);
  }
  execvp(options.program.c_str(), arguments);
  _exit(127);
}

}  // namespace

bool is_in_path(const std::string& program) {
  const char* folders = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
  std::istringstream list(folders ? folders : "");
  for (std::string folder; std::getline(list, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

Result<ChildProcess> ChildProcess::start(const Options& options) {
  const bool is_path = options.program.find('/') != std::string::npos;
  if (!is_path && !is_in_path(options.program))
    return fail(options.program + ": is not installed, or not in PATH");
  if (is_path && access(options.program.c_str(), X_OK) != 0)
    return fail(options.program +
                ": cannot be run; was it built, or installed? ./dance setup builds all");
  std::vector<char*> arguments{const_cast<char*>(options.program.c_str())};
  for (const std::string& argument : options.arguments)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) return fail(options.program + ": fork failed; is the machine out of processes?");
  if (pid == 0) become(options, arguments.data(), parent);
  return ChildProcess(pid);
}

Result<ChildProcess> ChildProcess::start_copy(const std::function<int()>& body) {
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) return fail("fork failed; is the machine out of processes?");
  if (pid == 0) {
    follow(parent);
    // An exception must not unwind into what the parent has on its stack.
    const auto run = [&]() noexcept { return body(); };
    _exit(run());
  }
  return ChildProcess(pid);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept { *this = std::move(other); }

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this == &other) return *this;
  stop(Duration::s(1));
  pid_ = std::exchange(other.pid_, -1);
  ended_ = other.ended_;
  exit_code_ = other.exit_code_;
  end_signal_ = other.end_signal_;
  exit_text_ = std::move(other.exit_text_);
  return *this;
}

ChildProcess::~ChildProcess() { stop(Duration::s(1)); }

void ChildProcess::note_end(int status) {
  ended_ = true;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  end_signal_ = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  exit_text_ = WIFSIGNALED(status) ? "ended by signal " + std::to_string(WTERMSIG(status))
                                   : "ended with exit " + std::to_string(WEXITSTATUS(status));
}

bool ChildProcess::has_ended() {
  if (pid_ < 0 || ended_) return true;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) == pid_) note_end(status);
  return ended_;
}

std::optional<Duration> cpu_time_of(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0)
    return std::nullopt;
  return Duration::s(time.tv_sec) + Duration::ns(time.tv_nsec);
}

Duration ChildProcess::cpu_time() const { return cpu_time_of(pid_).value_or(Duration()); }

bool ChildProcess::wait(Duration timeout) {
  for (Duration waited; !has_ended() && waited < timeout; waited += Duration::ms(5)) usleep(5000);
  return has_ended();
}

bool send_signal(pid_t process, int signal) { return process > 1 && kill(process, signal) == 0; }

bool ChildProcess::send_signal(int signal) {
  return !has_ended() && dance::send_signal(pid_, signal);
}

void ChildProcess::ask_to_stop() { send_signal(SIGTERM); }

void ChildProcess::stop(Duration timeout) {
  ask_to_stop();
  if (!wait(timeout)) kill_now();
}

void ChildProcess::kill_now() {
  if (!send_signal(SIGKILL)) return;
  int status = 0;
  if (waitpid(pid_, &status, 0) == pid_) note_end(status);
}

}  // namespace dance
