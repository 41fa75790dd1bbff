// Confinement of threads that read strangers' files: avatars, music, videos. A damaged or hostile
// file may find a fault in a decoder; what that fault can do is then limited by the kernel.
//
// A confined thread can compute, allocate memory, open files for reading, start threads that are
// confined too, and write to standard output and error. It cannot start programs, open sockets,
// create or change files (but for their times), map code, or signal or slow other processes: such
// calls fail with EPERM. It still shares the memory of its process, so this slows an attacker down
// and is no sandbox.
//
// Ownership: a ConfinedThread owns its thread; calls borrow what they use.
// Threads:   call() may be used by one thread at a time; it waits for the result.
// Failure:   confine_thread() is false where the kernel or the build has no seccomp, and in builds
//            with sanitizers, whose checks need more. The thread then runs unconfined.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <type_traits>

#include "core/base/result.h"

namespace dance {

// Confines the calling thread for the rest of its life, and the threads that it starts afterwards.
bool confine_thread();

// The reason, in our words, why a library's exception left a file unread: the library's own text
// names no cure.
std::string unread_because(const std::exception& failure);

// A confined thread that runs one function after the other, for readers that keep a file open.
class ConfinedThread {
 public:
  ConfinedThread() = default;
  ~ConfinedThread();
  ConfinedThread(const ConfinedThread&) = delete;
  ConfinedThread& operator=(const ConfinedThread&) = delete;

  // Runs `function`, which returns a Result, and returns what it returns. An exception becomes an
  // Error, and so does a thread that cannot be started.
  template <class Function>
  std::invoke_result_t<Function> call(Function function) {
    std::optional<std::invoke_result_t<Function>> result;
    std::string what;
    if (!run([&] {
          try {
            result.emplace(function());
          } catch (const std::exception& failure) {
            what = unread_because(failure);
          }
        }))
      return fail("no thread for it could be started");
    if (!result) return fail(std::move(what));
    return std::move(*result);
  }

 private:
  // False where no thread could be started.
  bool run(std::function<void()> task);
  void serve();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> task_;  // guarded; empty: nothing to do
  bool ends_ = false;           // guarded
  std::thread thread_;
};

// Runs `function`, which returns a Result, on a confined thread of its own, and waits for it.
template <class Function>
std::invoke_result_t<Function> run_confined(Function function) {
  return ConfinedThread().call(std::move(function));
}

}  // namespace dance
