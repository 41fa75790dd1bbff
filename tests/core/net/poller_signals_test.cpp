#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "core/net/poller.h"

namespace dance {
namespace {

// GCC's thread sanitizer hands signals to their handlers itself, and under load one in a hundred to
// nobody: there the signal is sent again each second.
#ifdef __SANITIZE_THREAD__
constexpr int kTurnsPerSignal = 10;
#else
constexpr int kTurnsPerSignal = 1'000'000;
#endif

// As OpenBLAS does when it is loaded: a thread that was there before anything was blocked.
TEST(PollerSignals, ReachThePollerWhicheverThreadTheyHit) {
  std::atomic<bool> is_over{false};
  std::thread early([&] {
    while (!is_over) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  auto poller = Poller::create();
  ASSERT_TRUE(poller) << poller.error().what;
  ASSERT_TRUE((*poller)->stop_on_signals());
  for (int turn = 0; turn < 600 && !(*poller)->is_stopped(); ++turn) {
    if (turn % kTurnsPerSignal == 0) {
      EXPECT_EQ(pthread_kill(early.native_handle(), SIGTERM), 0);
    }
    (*poller)->run_once(Duration::ms(100));
  }
  EXPECT_TRUE((*poller)->is_stopped());
  is_over = true;
  early.join();
}

// A terminal that is closed ends a recording as a request to end does.
TEST(PollerSignals, AHangupEndsItUnlessItIsIgnored) {
  for (const bool is_ignored : {true, false}) {
    const auto before = std::signal(SIGHUP, is_ignored ? SIG_IGN : SIG_DFL);
    {
      auto poller = Poller::create();
      ASSERT_TRUE(poller) << poller.error().what;
      ASSERT_TRUE((*poller)->stop_on_signals());
      for (int turn = 0; turn < 600 && !(*poller)->is_stopped(); ++turn) {
        if (turn % kTurnsPerSignal == 0) {
          EXPECT_EQ(raise(SIGHUP), 0);
        }
        (*poller)->run_once(Duration::ms(is_ignored ? 0 : 100));
      }
      EXPECT_EQ((*poller)->is_stopped(), !is_ignored);
    }
    std::signal(SIGHUP, before);
  }
}

}  // namespace
}  // namespace dance
