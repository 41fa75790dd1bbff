#include "core/base/time.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(Duration, KeepsEveryUnitExactly) {
  EXPECT_EQ(Duration::us(1), Duration::ns(1000));
  EXPECT_EQ(Duration::ms(1), Duration::us(1000));
  EXPECT_EQ(Duration::s(1), Duration::ms(1000));
  EXPECT_EQ(Duration::s(-3).count_ms(), -3000);
  EXPECT_DOUBLE_EQ(Duration::us(1500).as_ms(), 1.5);
  EXPECT_DOUBLE_EQ(Duration::ns(1500).as_us(), 1.5);
}

TEST(Duration, RoundsSecondsToTheNearestNanosecond) {
  EXPECT_EQ(Duration::seconds(1e-9), Duration::ns(1));
  EXPECT_EQ(Duration::seconds(1.6e-9), Duration::ns(2));
  EXPECT_EQ(Duration::seconds(-1.6e-9), Duration::ns(-2));
  EXPECT_EQ(Duration::period_of_hz(60.0), Duration::ns(16'666'667));
  EXPECT_EQ(Duration::seconds(0.1) + Duration::seconds(0.2), Duration::seconds(0.3));
}

TEST(Duration, AddsSubtractsAndScales) {
  Duration d = Duration::ms(5);
  d += Duration::ms(2);
  d -= Duration::ms(10);
  EXPECT_EQ(d, -Duration::ms(3));
  EXPECT_EQ(d * 4, Duration::ms(-12));
  EXPECT_EQ(Duration::ms(9) / 2, Duration::us(4500));
  EXPECT_LT(d, Duration());
}

TEST(MonoTime, IsUnsetOnlyAtTheZeroOfItsClock) {
  EXPECT_FALSE(MonoTime().is_set());
  EXPECT_TRUE(MonoTime::from_ns(1).is_set());
  EXPECT_EQ(MonoTime::from_us(7).since_zero_ns(), 7000);
  EXPECT_EQ(MonoTime::from_ns(7999).since_zero_us(), 7);
}

TEST(MonoTime, DiffersByDurations) {
  const MonoTime a = MonoTime::from_us(100);
  MonoTime b = a + Duration::us(50);
  EXPECT_EQ(b - a, Duration::us(50));
  EXPECT_EQ(a - b, Duration::us(-50));
  EXPECT_EQ(b - Duration::us(50), a);
  EXPECT_GT(b, a);
  b += Duration::us(-50);
  EXPECT_EQ(b, a);
}

}  // namespace
}  // namespace dance
