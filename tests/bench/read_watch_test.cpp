#include "bench/adapter/read_watch.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace dance {
namespace {

TEST(ReadWatch, AReadThatWaitsIsCountedAndOneThatDoesNotIsNot) {
  ReadWatch watch;
  volatile int work = 0;
  for (int i = 0; i < 100; ++i) watch([&] { work = work + 1; });
  EXPECT_EQ(watch.blocked(), 0u);
  watch([] { usleep(2000); });
  EXPECT_EQ(watch.blocked(), 1u);
  EXPECT_GE(watch.longest_wall(), Duration::ms(2));
}

TEST(ReadWatch, AReadThatGoesRoundAndRoundIsCounted) {
  ReadWatch watch;
  const auto used = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return Duration::s(t.tv_sec) + Duration::ns(t.tv_nsec);
  };
  watch([&] {
    const Duration end = used() + ReadWatch::kHangs + Duration::ms(10);
    while (used() < end) {
    }
  });
  EXPECT_EQ(watch.blocked(), 1u);
  EXPECT_GE(watch.longest_processor(), ReadWatch::kHangs);
}

}  // namespace
}  // namespace dance
