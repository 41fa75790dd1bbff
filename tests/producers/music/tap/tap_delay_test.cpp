#include "producers/music/tap/tap_delay.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/net/mono_clock.h"
#include "producers/music/tap/tap_program.h"

namespace dance {
namespace {

// A person who hears each click `delay_s` late, and taps with that standard deviation.
TapDelay tapped(double delay_s, double deviation_s, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> off(0.0, 1.0);
  TapDelay taps;
  for (int click = 3; click < 3 + 14; ++click)
    taps.tap(TapDelay::kPeriod_s * click + delay_s + deviation_s * off(random));
  return taps;
}

TEST(TapDelay, FindsTheDelayOfAPersonWhoTapsEvenly) {
  for (const double delay_s : {-0.15, 0.0, 0.04, 0.18, 0.399, 0.401, 0.55})
    for (unsigned seed = 0; seed < 20; ++seed) {
      const TapDelay::Result result = tapped(delay_s, 0.018, seed).result();
      ASSERT_EQ(result.state, TapDelay::State::kFound) << delay_s << " " << seed;
      EXPECT_NEAR(result.delay_s, delay_s, 0.020) << seed;
    }
}

TEST(TapDelay, IsNotMovedByTheFirstTapsNorByThreeThatMiss) {
  TapDelay taps;
  for (int click = 0; click < 14; ++click) {
    const bool misses = click < 2 || click == 5 || click == 8 || click == 11;
    taps.tap(TapDelay::kPeriod_s * click + 0.2 + (misses ? 0.17 : 0.002 * (click % 3)));
  }
  const TapDelay::Result result = taps.result();
  ASSERT_EQ(result.state, TapDelay::State::kFound);
  EXPECT_NEAR(result.delay_s, 0.2, 0.005);
}

TEST(TapDelay, RefusesTapsThatScatterOverThePeriod) {
  // Two in a row that are nearly one count as one, and some are missing then.
  int found = 0, scattered = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const TapDelay::State state = tapped(0.1, 0.2, seed).result().state;
    found += state == TapDelay::State::kFound ? 1 : 0;
    scattered += state == TapDelay::State::kScattered ? 1 : 0;
  }
  EXPECT_EQ(found, 0);
  EXPECT_GE(scattered, 30);
}

TEST(TapDelay, CountsAKeyThatBouncesOnceAndNoTimeThatIsNone) {
  TapDelay taps;
  EXPECT_EQ(taps.result().missing, 13u);
  taps.tap(1.0);
  taps.tap(1.05);
  taps.tap(std::numeric_limits<double>::quiet_NaN());
  taps.tap(std::numeric_limits<double>::infinity());
  EXPECT_EQ(taps.result().missing, 12u);
  EXPECT_EQ(taps.result().state, TapDelay::State::kNeedsMore);
}

// Keeps a time of the test's own: each reading is the next tap.
class TappedPlayer : public SilentPlayer {
 public:
  std::optional<double> heard_s(MonoTime) const override {
    return TapDelay::kPeriod_s * ++taps_ + 0.25;
  }

 private:
  mutable int taps_ = 0;
};

TEST(TapProgram, TakesALineForATapAndEndsWithItsInput) {
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  TappedPlayer player;
  int written = 0;
  (*poller)->add_timer(mono_now(), [&](MonoTime now) {
    EXPECT_EQ(::write(ends[1], written % 2 == 0 ? "\n" : "x", 1), 1);
    return ++written < 28 ? now + Duration::ms(2) : MonoTime();
  });
  const auto found = run_taps(player, ends[0], **poller);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->delay_s, 0.25, 1e-9);
  auto other = Poller::create();
  ASSERT_TRUE(other);
  close(ends[1]);
  const auto ended = run_taps(player, ends[0], **other);
  ASSERT_FALSE(ended);
  EXPECT_NE(ended.error().what.find("standard input has ended"), std::string::npos);
  close(ends[0]);
}

TEST(ClickSource, ClicksOnceAPeriod) {
  ClickSource source;
  std::vector<float> samples(2 * 48000 * 2);
  ASSERT_TRUE(source.read(-4800, samples));
  std::vector<double> begins_s;
  double last_s = -1.0;
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    const double s = static_cast<double>(i / 2) / 48000.0 - 0.1;
    if (std::abs(samples[i]) < 0.01f) continue;
    if (s - last_s > 0.1) begins_s.push_back(s);
    last_s = s;
  }
  ASSERT_EQ(begins_s.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(begins_s[i], 0.8 * static_cast<double>(i), 0.001);
}

}  // namespace
}  // namespace dance
