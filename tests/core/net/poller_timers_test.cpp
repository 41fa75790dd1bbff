#include <gtest/gtest.h>

#include <vector>

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

// The kernel's timer stays armed for the earlier moment: nothing may run then, and nothing be lost.
TEST(PollerTimers, ADeadlineThatMovesOnIsMetThenAndNotBefore) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller) << poller.error().what;
  std::vector<MonoTime> ran;
  const MonoTime begin = mono_now();
  const Poller::TimerId timer = (*poller)->add_timer(begin + Duration::ms(5), [&](MonoTime at) {
    ran.push_back(at);
    return MonoTime();
  });
  (*poller)->run_once(Duration::ms(0));  // arms
  (*poller)->set_deadline(timer, begin + Duration::ms(20));
  for (int i = 0; i < 1000 && ran.empty(); ++i) (*poller)->run_once(Duration::ms(1000));
  ASSERT_EQ(ran.size(), 1u);
  EXPECT_GE(ran[0], begin + Duration::ms(20));

  // Stopped, and set again later than the moment that is still armed.
  const MonoTime again = mono_now();
  (*poller)->set_deadline(timer, again + Duration::ms(5));
  (*poller)->run_once(Duration::ms(0));
  (*poller)->set_deadline(timer, MonoTime());
  (*poller)->run_once(Duration::ms(0));
  (*poller)->set_deadline(timer, again + Duration::ms(15));
  for (int i = 0; i < 1000 && ran.size() < 2; ++i) (*poller)->run_once(Duration::ms(1000));
  ASSERT_EQ(ran.size(), 2u);
  EXPECT_GE(ran[1], again + Duration::ms(15));
}

}  // namespace
}  // namespace dance
