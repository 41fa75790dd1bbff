#include "tunnel/server/pace/line_budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr double kAll = 100e3;

// A line and what is sent over it, a report each 200 ms.
struct LineScene {
  LineBudget budget;
  MonoTime now = MonoTime::from_us(1'000'000);
  Duration base = Duration::ms(20);
  double queued_bytes = 0.0;

  void report(double bytes_per_s, double loss, Duration round_trip) {
    now += Duration::ms(200);
    budget.update({bytes_per_s, loss, round_trip}, kAll, now);
  }
  // A line that bears so much, with a queue of 250 ms before it; sends what the budget allows.
  void pass(double line_bytes_per_s, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.2) {
      const double rate = std::min(budget.bytes_per_second(), kAll);
      const double most = line_bytes_per_s * 0.25;
      queued_bytes = std::max(0.0, queued_bytes + (rate - line_bytes_per_s) * 0.2);
      const double lost = std::max(0.0, queued_bytes - most);
      queued_bytes -= lost;
      report(rate, lost / (rate * 0.2), base + Duration::seconds(queued_bytes / line_bytes_per_s));
    }
  }
};

TEST(LineBudget, IsUnlimitedWhereTheLineTakesEverything) {
  LineScene scene;
  Random random(1);
  // Round trips wander, some are very late, and one in a hundred is lost.
  for (int i = 0; i < 3000; ++i) {
    const bool is_late = random.uniform() < 0.05;
    scene.report(kAll, random.uniform(0.0, 0.02),
                 Duration::ms(20) + Duration::us(static_cast<std::int64_t>(
                                        random.uniform(0.0, is_late ? 200e3 : 15e3))));
    ASSERT_FALSE(scene.budget.is_limited()) << i;
  }
}

TEST(LineBudget, FollowsALineThatIsTooNarrowAndStaysNearIt) {
  for (const double line : {10e3, 40e3, 80e3}) {
    LineScene scene;
    scene.pass(200e3, 5.0);
    ASSERT_FALSE(scene.budget.is_limited());
    scene.pass(line, 20.0);
    ASSERT_TRUE(scene.budget.is_limited()) << line;
    double sum = 0.0;
    constexpr int kSteps = 300;
    for (int i = 0; i < kSteps; ++i) {
      scene.pass(line, 0.2);
      sum += scene.budget.bytes_per_second();
      EXPECT_LT(scene.budget.bytes_per_second(), line * 1.3 + 4e3) << line;
    }
    EXPECT_GT(sum / kSteps, line * 0.7) << line;
    EXPECT_LT(sum / kSteps, line * 1.05) << line;
  }
}

TEST(LineBudget, IsUnlimitedAgainWhereTheLineGrewWide) {
  LineScene scene;
  scene.pass(30e3, 20.0);
  ASSERT_TRUE(scene.budget.is_limited());
  scene.pass(200e3, 30.0);
  EXPECT_TRUE(scene.budget.is_limited()) << "not at once";
  scene.pass(200e3, 40.0);
  EXPECT_FALSE(scene.budget.is_limited());
}

TEST(LineBudget, MuchLossLowersItAndLittleDoesNot) {
  LineScene little, much;
  for (int i = 0; i < 100; ++i) little.report(kAll, 0.05, Duration::ms(20));
  EXPECT_FALSE(little.budget.is_limited());
  much.report(kAll, 0.2, Duration::ms(20));
  EXPECT_DOUBLE_EQ(much.budget.bytes_per_second(), LineBudget::kLess * kAll);
  // Some loss holds it where it is; and one report's loss counts once.
  for (int i = 0; i < 100; ++i) much.report(kAll, 0.05, Duration::ms(20));
  EXPECT_DOUBLE_EQ(much.budget.bytes_per_second(), LineBudget::kLess * kAll);
}

TEST(LineBudget, NeverFallsBelowItsLeast) {
  LineScene queue, loss;
  queue.report(kAll, 0.0, Duration::ms(20));
  for (int i = 0; i < 40; ++i) queue.report(0.0, 1.0, Duration::ms(900));
  EXPECT_DOUBLE_EQ(queue.budget.bytes_per_second(), LineBudget::kLeast);
  for (int i = 0; i < 40; ++i) loss.report(0.0, 1.0, Duration::ms(20));
  EXPECT_DOUBLE_EQ(loss.budget.bytes_per_second(), LineBudget::kLeastForLoss);
}

TEST(LineBudget, LossOfWhatEveryLineBearsIsNotForWantOfBytes) {
  LineBudget budget;
  MonoTime now = MonoTime::from_us(1);
  for (int i = 0; i < 100; ++i)
    budget.update({40e3, 0.3, Duration::ms(20)}, 40e3, now += Duration::ms(200));
  EXPECT_FALSE(budget.is_limited());
}

TEST(LineBudget, ALongerWayIsNotAQueueForGood) {
  LineScene scene;
  for (int i = 0; i < 50; ++i) scene.report(kAll, 0.0, Duration::ms(20));
  // The way changed: at first that looks like a queue.
  for (int i = 0; i < 25; ++i) scene.report(kAll, 0.0, Duration::ms(120));
  ASSERT_TRUE(scene.budget.is_limited());
  for (int i = 0; i < 1000; ++i) scene.report(kAll, 0.0, Duration::ms(120));
  EXPECT_FALSE(scene.budget.is_limited());
}

TEST(LineBudget, AnUnknownRoundTripTellsNothing) {
  LineScene scene;
  for (int i = 0; i < 10; ++i) scene.report(kAll, 0.0, Duration());
  for (int i = 0; i < 10; ++i) scene.report(kAll, 0.0, Duration::ms(300));
  EXPECT_FALSE(scene.budget.is_limited());
}

}  // namespace
}  // namespace dance
