// Look-ups of names in a thread of their own.
#include "core/net/names/name_lookup.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <atomic>
#include <csignal>
#include <future>

#include "core/net/mono_clock.h"
#include "core/net/poller.h"

namespace dance {
namespace {

std::optional<NameLookup::Addresses> answer_of(NameLookup& lookup) {
  pollfd readable{lookup.fd(), POLLIN, 0};
  EXPECT_EQ(poll(&readable, 1, 30'000), 1);
  return lookup.take();
}

TEST(NameLookup, GivesEachAnswerOnceAndMayBeginAgain) {
  std::atomic<int> count = 0;
  auto lookup = NameLookup::create([&]() -> NameLookup::Addresses {
    if (++count == 1) return fail("unknown");
    return std::vector{Address::loopback(7400)};
  });
  ASSERT_TRUE(lookup);
  EXPECT_FALSE((*lookup)->take());
  (*lookup)->begin();
  (*lookup)->begin();  // one at a time
  const auto first = answer_of(**lookup);
  ASSERT_TRUE(first);
  ASSERT_FALSE(*first);
  EXPECT_EQ(first->error().what, "unknown");
  EXPECT_FALSE((*lookup)->take());
  EXPECT_EQ(count, 1);
  (*lookup)->begin();
  const auto second = answer_of(**lookup);
  ASSERT_TRUE(second && *second);
  EXPECT_EQ((*second)->front(), Address::loopback(7400));
}

TEST(NameLookup, MayEndWhileTheResolverIsSilent) {
  std::promise<void> release;
  std::promise<void> ended;
  std::shared_future<void> released = release.get_future();
  auto lookup = NameLookup::create([released, &ended]() -> NameLookup::Addresses {
    released.wait();
    ended.set_value();
    return std::vector{Address::loopback(1)};
  });
  ASSERT_TRUE(lookup);
  (*lookup)->begin();
  EXPECT_TRUE((*lookup)->is_running());
  lookup->reset();
  release.set_value();
  ended.get_future().wait();
}

TEST(NameLookup, ASignalEndsTheWaitForASilentResolver) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller && (*poller)->stop_on_signals());
  std::promise<void> release;
  std::shared_future<void> released = release.get_future();
  auto lookup = NameLookup::create([released]() -> NameLookup::Addresses {
    released.wait();
    return fail("the name server does not answer");
  });
  ASSERT_TRUE(lookup);
  (*lookup)->begin();
  EXPECT_FALSE((*poller)->wait_for((*lookup)->fd(), Duration::ms(1)));
  EXPECT_FALSE((*poller)->is_stopped());
  std::raise(SIGINT);
  EXPECT_FALSE((*poller)->wait_for((*lookup)->fd(), Duration::s(3600)));
  EXPECT_TRUE((*poller)->is_stopped());
  release.set_value();
}

}  // namespace
}  // namespace dance
