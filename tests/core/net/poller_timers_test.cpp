#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"

namespace dance {
namespace {

TEST(PollerTimers, ARemovedTimerNeverRunsAgainAndItsPlaceIsTheNextOnes) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller) << poller.error().what;
  int ran = 0, kept = 0;
  const auto now = mono_now();
  const Poller::TimerId first = (*poller)->add_timer(now, [&](MonoTime at) {
    ++ran;
    return at;
  });
  (*poller)->add_timer(now, [&](MonoTime at) {
    ++kept;
    return at;
  });
  (*poller)->run_once(Duration::ms(10));
  EXPECT_EQ(ran, 1);
  (*poller)->remove_timer(first);
  for (int i = 0; i < 3; ++i) (*poller)->run_once(Duration::ms(10));
  EXPECT_EQ(ran, 1);
  EXPECT_GT(kept, 1);
  int next = 0;
  EXPECT_EQ((*poller)->add_timer(now,
                                 [&](MonoTime) {
                                   ++next;
                                   return MonoTime();
                                 }),
            first);
  (*poller)->run_once(Duration::ms(10));
  EXPECT_EQ(next, 1);
  EXPECT_EQ(ran, 1);
}

TEST(PollerTimers, ATimerMayRemoveItself) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller) << poller.error().what;
  int ran = 0, other = 0;
  Poller::TimerId timer = 0;
  timer = (*poller)->add_timer(mono_now(), [&](MonoTime at) {
    (*poller)->remove_timer(timer);
    // Not in its place, which is in use.
    EXPECT_NE((*poller)->add_timer(at,
                                   [&](MonoTime) {
                                     ++other;
                                     return MonoTime();
                                   }),
              timer);
    ++ran;
    return at;
  });
  for (int i = 0; i < 3; ++i) (*poller)->run_once(Duration::ms(10));
  EXPECT_EQ(ran, 1);
  EXPECT_EQ(other, 1);
}

}  // namespace
}  // namespace dance
