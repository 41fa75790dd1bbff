#include "tunnel/cluster/session_clock.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr Duration kAhead = Duration::s(1000);

ClockMapper::Sample sample(MonoTime sent, Duration there, Duration back, Duration ahead = kAhead) {
  const MonoTime received = sent + there;
  return {sent, (received + ahead).since_zero_us(), (received + ahead).since_zero_us(),
          received + back};
}

TEST(SessionClock, IsOursUntilAnotherIsMeasured) {
  SessionClock clock;
  const MonoTime now = MonoTime::from_us(5'000'000);
  EXPECT_EQ(clock.to_session(now), now);
  EXPECT_FALSE(clock.is_measured());
}

TEST(SessionClock, IsTheOthersAfterAFewQuestions) {
  SessionClock clock;
  MonoTime now = MonoTime::from_us(5'000'000);
  Random random(3);
  for (int i = 0; i < 20; ++i, now += Duration::ms(20))
    clock.add(sample(now, Duration::seconds(300e-6 + random.uniform() * 200e-6),
                     Duration::seconds(300e-6 + random.uniform() * 200e-6)));
  EXPECT_TRUE(clock.is_measured());
  EXPECT_NEAR((clock.to_session(now) - now).as_seconds(), kAhead.as_seconds(), 150e-6);
  EXPECT_EQ(clock.to_ours(clock.to_session(now)), now);
  EXPECT_EQ(clock.steps(), 1u) << "on joining";
}

TEST(SessionClock, GoesOnWithoutAJumpUnderAnotherLeader) {
  SessionClock clock;
  MonoTime now = MonoTime::from_us(5'000'000);
  for (int i = 0; i < 20; ++i, now += Duration::ms(20))
    clock.add(sample(now, Duration::us(400), Duration::us(400)));
  clock.begin();
  EXPECT_FALSE(clock.is_measured());
  EXPECT_NEAR((clock.to_session(now) - now).as_seconds(), kAhead.as_seconds(), 1e-6);
  // The next one's is 3 ms off: reached, but slowly, and never backwards.
  const Duration other = kAhead - Duration::ms(3);
  MonoTime before = clock.to_session(now);
  for (int i = 0; i < 80'000; ++i, now += Duration::us(250)) {  // turns much shorter than 1 ms
    if (i % 80 == 0) clock.add(sample(now, Duration::us(400), Duration::us(400), other));
    clock.advance(now + Duration::us(250));
    const MonoTime session = clock.to_session(now + Duration::us(250));
    EXPECT_GE(session, before);
    EXPECT_LT(session - before, Duration::us(251));
    before = session;
  }
  EXPECT_NEAR((clock.to_session(now) - now).as_seconds(), other.as_seconds(), 50e-6);
  EXPECT_EQ(clock.steps(), 1u);
}

}  // namespace
}  // namespace dance
