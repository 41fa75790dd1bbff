#include "core/program/confinement.h"

#include <utility>

#if defined(DANCE_HAVE_SECCOMP) && !defined(DANCE_SANITIZED)
#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#endif

namespace dance {

#if defined(DANCE_HAVE_SECCOMP) && !defined(DANCE_SANITIZED)
namespace {

// Calls that allocators, decoders, the C library's threads and file reading need.
constexpr int kAllowed[] = {
    // Memory.
    SCMP_SYS(brk), SCMP_SYS(madvise), SCMP_SYS(mremap), SCMP_SYS(munmap),
    // Files that are open or opened for reading.
    SCMP_SYS(_llseek), SCMP_SYS(access), SCMP_SYS(close), SCMP_SYS(faccessat), SCMP_SYS(faccessat2),
    SCMP_SYS(fadvise64), SCMP_SYS(fstat), SCMP_SYS(fstat64), SCMP_SYS(fstatat64), SCMP_SYS(fstatfs),
    SCMP_SYS(getdents64), SCMP_SYS(lseek), SCMP_SYS(lstat), SCMP_SYS(newfstatat), SCMP_SYS(pread64),
    SCMP_SYS(preadv), SCMP_SYS(read), SCMP_SYS(readlink), SCMP_SYS(readlinkat), SCMP_SYS(readv),
    SCMP_SYS(stat), SCMP_SYS(statx),
    // The time at which a stored file was last used.
    SCMP_SYS(utimensat),
    // Threads, locks, clocks, signals to itself.
    SCMP_SYS(clock_getres), SCMP_SYS(clock_gettime), SCMP_SYS(clock_nanosleep), SCMP_SYS(exit),
    SCMP_SYS(exit_group), SCMP_SYS(futex), SCMP_SYS(get_robust_list), SCMP_SYS(getcpu),
    SCMP_SYS(getpid), SCMP_SYS(getrandom), SCMP_SYS(gettid), SCMP_SYS(gettimeofday),
    SCMP_SYS(membarrier), SCMP_SYS(nanosleep), SCMP_SYS(restart_syscall), SCMP_SYS(rseq),
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sched_getaffinity), SCMP_SYS(sched_yield), SCMP_SYS(set_robust_list),
    SCMP_SYS(sigaltstack), SCMP_SYS(sysinfo), SCMP_SYS(uname)};

constexpr unsigned kWriteFlags = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;

// Adds the permitted calls; returns 0 on success.
int add_rules(scmp_filter_ctx filter) {
  int error = 0;
  const auto allow = [&](int call, auto... conditions) {
    error |= seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, sizeof...(conditions), conditions...);
  };
  for (const int call : kAllowed) allow(call);
  allow(SCMP_SYS(open), scmp_arg_cmp{1, SCMP_CMP_MASKED_EQ, kWriteFlags, O_RDONLY});
  allow(SCMP_SYS(openat), scmp_arg_cmp{2, SCMP_CMP_MASKED_EQ, kWriteFlags, O_RDONLY});
  // Only the flags of descriptors: F_SETOWN could send signals to other processes.
  for (const int call : {SCMP_SYS(fcntl), SCMP_SYS(fcntl64)})
    for (const int command : {F_GETFD, F_SETFD, F_GETFL})
      allow(call, scmp_arg_cmp{1, SCMP_CMP_EQ, static_cast<scmp_datum_t>(command), 0});
  // Memory that holds data, never code.
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mmap2), SCMP_SYS(mprotect)})
    allow(call, scmp_arg_cmp{2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0});
  // Messages of libraries.
  for (const int call : {SCMP_SYS(write), SCMP_SYS(writev)})
    allow(call, scmp_arg_cmp{0, SCMP_CMP_LE, STDERR_FILENO, 0});
  // abort(), and the C library's cancellation.
  allow(SCMP_SYS(tgkill), scmp_arg_cmp{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()), 0});
  // Threads but no processes. The flags of clone3 lie in memory, where a filter cannot look: the C
  // library falls back to clone.
  allow(SCMP_SYS(clone), scmp_arg_cmp{0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD});
  error |= seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
  return error;
}

}  // namespace

bool confine_thread() {
  const std::unique_ptr<void, void (*)(void*)> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)),
                                                      seccomp_release);
  return filter && add_rules(filter.get()) == 0 && seccomp_load(filter.get()) == 0;
}
#else
bool confine_thread() { return false; }
#endif

std::string unread_because(const std::exception& failure) {
  if (dynamic_cast<const std::bad_alloc*>(&failure))
    return "needs more memory than there is; end other programs, or make it smaller";
  return "damaged in a way that its reader cannot name; copy it again, or export it again";
}

ConfinedThread::~ConfinedThread() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool ConfinedThread::run(std::function<void()> task) {
  if (!thread_.joinable()) {
    try {
      thread_ = std::thread([this] { serve(); });
    } catch (const std::system_error&) {
      return false;
    }
  }
  std::unique_lock lock(mutex_);
  task_ = std::move(task);
  changed_.notify_all();
  changed_.wait(lock, [this] { return !task_; });
  return true;
}

void ConfinedThread::serve() {
  confine_thread();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || task_; });
    if (ends_) return;
    lock.unlock();
    task_();
    lock.lock();
    task_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace dance
