#include "headset/program/stall_guard.h"

#include <pthread.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "core/net/mono_clock.h"
#include "core/program/talk.h"

namespace dance {
namespace {

// Blocked, and not read yet.
bool is_signal_pending() {
  sigset_t pending;
  return sigpending(&pending) == 0 &&
         (sigismember(&pending, SIGINT) == 1 || sigismember(&pending, SIGTERM) == 1);
}

}  // namespace

StallGuard::StallGuard(std::function<bool()> is_asked) : is_asked_(std::move(is_asked)) {
  beat();
  thread_ = std::thread([this] { watch(); });
  pthread_setname_np(thread_.native_handle(), "headset-guard");
}

StallGuard::~StallGuard() {
  ends_.store(true, std::memory_order_release);
  thread_.join();
}

void StallGuard::beat() { beat_ns_.store(mono_now().since_zero_ns(), std::memory_order_release); }

void StallGuard::watch() {
  while (!ends_.load(std::memory_order_acquire)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const MonoTime beat = MonoTime::from_ns(beat_ns_.load(std::memory_order_acquire));
    if (mono_now() - beat < kPatience || !(is_signal_pending() || is_asked_())) continue;
    talk::warn("the headset's runtime does not answer; ending without it");
    _exit(1);
  }
}

}  // namespace dance
