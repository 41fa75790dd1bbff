#include "core/program/part_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace dance {
namespace {

constexpr std::array kEnds{SIGINT, SIGTERM, SIGHUP};

// Of the part file that a signal removes.
std::atomic<const char*> unfinished{nullptr};
static_assert(std::atomic<const char*>::is_always_lock_free, "a signal handler reads it");

void remove_and_end(int signal) {
  if (const char* path = unfinished.exchange(nullptr)) ::unlink(path);
  ::raise(signal);  // SA_RESETHAND has put the usual end back
}

// While it lives, no signal comes between a file and its entry.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t ends;
    sigemptyset(&ends);
    for (const int signal : kEnds) sigaddset(&ends, signal);
    pthread_sigmask(SIG_BLOCK, &ends, &before_);
  }
  ~SignalsHeld() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_{};
};

void handle_ends() {
  for (const int signal : kEnds) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = remove_and_end;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

tl::unexpected<Error> is_there(const std::string& path) {
  return fail(path + ": is there already; remove it or choose another name");
}

tl::unexpected<Error> not_written(const std::string& path, int error) {
  return fail(path + ": " + std::generic_category().message(error) + "; choose another name");
}

// 0 or the error.
int move_file(const char* from, const char* to) {
  if (::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // A file system without that, as NFS.
  if (::link(from, to) != 0) return errno;
  ::unlink(from);
  return 0;
}

}  // namespace

Result<void> move_to_free_name(const std::string& from, const std::string& to) {
  const int error = move_file(from.c_str(), to.c_str());
  if (error != 0) return error == EEXIST ? is_there(to) : not_written(to, error);
  return {};
}

Result<std::unique_ptr<PartFile>> PartFile::create(const std::string& to) {
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(to, unknown))) return is_there(to);
  std::unique_ptr<PartFile> part(new PartFile(to));
  part->is_kept_ = true;  // until there is one
  const SignalsHeld held;
  const int file = ::open(part->path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return errno == EEXIST ? is_there(part->path_) : not_written(part->path_, errno);
  ::close(file);
  part->is_kept_ = false;
  const char* none = nullptr;
  if (unfinished.compare_exchange_strong(none, part->path_.c_str())) handle_ends();
  return part;
}

PartFile::~PartFile() {
  if (is_kept_) return;
  const SignalsHeld held;
  ::unlink(path_.c_str());
  forget();
}

Result<void> PartFile::keep() {
  const SignalsHeld held;
  if (auto moved = move_to_free_name(path_, to_); !moved) return moved;
  is_kept_ = true;
  forget();
  return {};
}

void PartFile::forget() {
  const char* own = path_.c_str();
  unfinished.compare_exchange_strong(own, nullptr);
}

}  // namespace dance
