// The pace of files: never above the rate, below it where the path suffers.
#include "tunnel/files/file_pace.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr double kChunk = 1100.0;

// Bytes that go in so long, asked each millisecond.
double sent_in(FilePace& pace, MonoTime& now, Duration duration) {
  double bytes = 0.0;
  for (const MonoTime end = now + duration; now < end; now += Duration::ms(1))
    while (pace.take(kChunk, now)) bytes += kChunk;
  return bytes;
}

TEST(FilePace, KeepsTheRateAndSendsNoTwoAtOnce) {
  FilePace pace(100'000.0, kChunk);
  MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_TRUE(pace.take(kChunk, now));
  EXPECT_FALSE(pace.take(kChunk, now));
  now += Duration::s(60);  // saves nothing up
  EXPECT_TRUE(pace.take(kChunk, now));
  EXPECT_FALSE(pace.take(kChunk, now));
  const double bytes = sent_in(pace, now, Duration::s(10));
  EXPECT_LE(bytes, 1'000'000.0 + kChunk);
  EXPECT_GT(bytes, 900'000.0);
}

TEST(FilePace, SaysWhenTheNextMayGo) {
  FilePace pace(100'000.0, kChunk);
  MonoTime now = MonoTime::from_us(1'000'000);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(pace.take(kChunk, now));
    const MonoTime next = pace.ready_at(kChunk);
    EXPECT_FALSE(pace.take(kChunk, next - Duration::us(100)));
    now = next;
  }
  EXPECT_FALSE(pace.ready_at(2.0 * kChunk).is_set()) << "more than it ever saves";
}

TEST(FilePace, SendsNothingAtRateNought) {
  FilePace pace(0.0, kChunk);
  EXPECT_FALSE(pace.take(1.0, MonoTime::from_us(5)));
  EXPECT_FALSE(pace.ready_at(1.0).is_set());
  EXPECT_FALSE(FilePace().take(1.0, MonoTime::from_us(5)));
}

TEST(FilePace, SlowsDownWhileTheRoundTripIsLongAndComesBack) {
  FilePace pace(100'000.0, kChunk);
  MonoTime now = MonoTime::from_us(1'000'000);
  for (int i = 0; i < 10; ++i, now += Duration::ms(200)) pace.see_round_trip(Duration::ms(40), now);
  EXPECT_EQ(pace.share(), 1.0);
  for (int i = 0; i < 10; ++i, now += Duration::ms(200))
    pace.see_round_trip(Duration::ms(120), now);
  EXPECT_LT(pace.share(), 0.2);
  const double slow = sent_in(pace, now, Duration::s(1));
  EXPECT_LT(slow, 40'000.0);
  for (int i = 0; i < 100; ++i, now += Duration::ms(200)) {
    pace.see_round_trip(Duration::ms(45), now);
    pace.take(kChunk, now);
  }
  EXPECT_EQ(pace.share(), 1.0);
}

TEST(FilePace, BearsAFewLossesAndYieldsToMany) {
  FilePace few(100'000.0, kChunk), many(100'000.0, kChunk);
  MonoTime now = MonoTime::from_us(1'000'000);
  for (int i = 0; i < 400; ++i, now += Duration::ms(10)) {
    i % 50 == 7 ? few.see_loss(now) : few.see_arrival();
    i % 3 == 0 ? many.see_loss(now) : many.see_arrival();
  }
  EXPECT_EQ(few.share(), 1.0);
  EXPECT_LE(many.share(), 0.1);
  EXPECT_GT(many.bytes_per_second(), 3'000.0) << "it never stops";
}

TEST(FilePace, IsAskedWithoutTaking) {
  FilePace pace(1000.0, 1000.0);
  const MonoTime now = MonoTime::from_us(1'000'000);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pace.has(1000.0, now));
  EXPECT_TRUE(pace.take(1000.0, now));
  EXPECT_FALSE(pace.has(1.0, now));
  EXPECT_TRUE(pace.has(500.0, now + Duration::ms(501)));
  EXPECT_FALSE(FilePace().has(1.0, now));
}

}  // namespace
}  // namespace dance
