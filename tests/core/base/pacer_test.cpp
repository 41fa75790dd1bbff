#include "core/base/pacer.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr MonoTime kStart = MonoTime::from_us(1'000'000);

TEST(Pacer, IsDueFromItsFirstDeadlineOn) {
  const Pacer pacer(kStart, 60.0);
  EXPECT_EQ(pacer.deadline(), kStart);
  EXPECT_TRUE(pacer.is_due(kStart));
  EXPECT_FALSE(pacer.is_due(kStart - Duration::ns(1)));
}

TEST(Pacer, NeverDriftsOverAnHourOfSixtyHertz) {
  Pacer pacer(kStart, 60.0);
  for (int i = 0; i < 60 * 3600; ++i) {
    // Each turn a little late: lateness must not add up.
    EXPECT_EQ(pacer.advance(pacer.deadline() + Duration::us(300)), Duration::us(300));
  }
  EXPECT_EQ(pacer.deadline(), kStart + Duration::s(3600));
  EXPECT_EQ(pacer.skipped(), 0u);
}

TEST(Pacer, CatchesUpWhenLessThanAPeriodLate) {
  Pacer pacer(kStart, 100.0);
  pacer.advance(kStart + Duration::ms(9));
  EXPECT_EQ(pacer.deadline(), kStart + Duration::ms(10));
  EXPECT_EQ(pacer.skipped(), 0u);
}

TEST(Pacer, SkipsWhatAStallHasMissedInsteadOfABurst) {
  Pacer pacer(kStart, 100.0);
  const Duration late = pacer.advance(kStart + Duration::ms(1005));
  EXPECT_EQ(late, Duration::ms(1005));
  // The deadline under way is still met, at once; the ones before it are gone.
  EXPECT_EQ(pacer.deadline(), kStart + Duration::ms(1000));
  EXPECT_EQ(pacer.skipped(), 99u);
  int burst = 0;
  while (pacer.is_due(kStart + Duration::ms(1005))) {
    pacer.advance(kStart + Duration::ms(1005));
    ++burst;
  }
  EXPECT_EQ(burst, 1);
  EXPECT_EQ(pacer.deadline(), kStart + Duration::ms(1010));
}

TEST(Pacer, IsNotConfusedByWorkDoneBeforeItsDeadline) {
  Pacer pacer(kStart, 100.0);
  EXPECT_EQ(pacer.advance(kStart - Duration::ms(3)), Duration::ms(-3));
  EXPECT_EQ(pacer.deadline(), kStart + Duration::ms(10));
}

TEST(PacerDeathTest, RefusesARateThatIsNone) {
  EXPECT_DEATH(Pacer(kStart, 0.0), "hz > 0.0");
  EXPECT_DEATH(Pacer(kStart, 1e9), "hz <= ");
}

}  // namespace
}  // namespace dance
