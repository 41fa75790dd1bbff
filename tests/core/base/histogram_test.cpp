#include "core/base/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/base/random.h"

namespace dance {
namespace {

TEST(Histogram, IsZeroWhenEmpty) {
  const Histogram histogram;
  EXPECT_EQ(histogram.percentile(0.5), Duration());
  EXPECT_EQ(histogram.max(), Duration());
  EXPECT_EQ(histogram.count(), 0u);
}

TEST(Histogram, IsExactBelowThirtyTwoMicroseconds) {
  for (int us = 0; us < 32; ++us) {
    Histogram histogram;
    histogram.add(Duration::us(us));
    EXPECT_EQ(histogram.percentile(0.5), Duration::us(us));
  }
}

TEST(Histogram, IsWithinTheStatedErrorFromMicrosecondsToAnHour) {
  for (double us = 32; us < 3.6e9; us *= 1.013) {
    Histogram histogram;
    // The larger one keeps the maximum out of the way of the smaller one's answer.
    histogram.add(Duration::us(static_cast<std::int64_t>(us)));
    histogram.add(Duration::s(4000));
    const double answer_us = histogram.percentile(0.0).as_us();
    EXPECT_NEAR(answer_us, std::floor(us), 0.022 * us);
  }
}

TEST(Histogram, AgreesWithSortingOnRandomLatencies) {
  Random random(20240301);
  const auto histogram = std::make_unique<Histogram>();
  std::vector<double> sorted_us;
  for (int i = 0; i < 20'000; ++i) {
    const auto us = static_cast<std::int64_t>(std::exp(random.uniform(0.0, 14.0)));
    sorted_us.push_back(static_cast<double>(us));
    histogram->add(Duration::us(us));
  }
  std::sort(sorted_us.begin(), sorted_us.end());
  for (const double fraction : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double expected_us = sorted_us[static_cast<std::size_t>(fraction * 19'999)];
    EXPECT_NEAR(histogram->percentile(fraction).as_us(), expected_us, 0.022 * expected_us + 0.5)
        << fraction;
  }
  EXPECT_EQ(histogram->max(), Duration::us(static_cast<std::int64_t>(sorted_us.back())));
}

TEST(Histogram, NeverAnswersMoreThanTheMaximum) {
  Histogram histogram;
  histogram.add(Duration::us(1024));
  EXPECT_EQ(histogram.percentile(1.0), Duration::us(1024));
}

TEST(Histogram, SumsUp) {
  Histogram all, first, second;
  for (int i = 1; i <= 1000; ++i) {
    all.add(Duration::us(i * i));
    (i % 3 == 0 ? first : second).add(Duration::us(i * i));
  }
  first.add(second);
  EXPECT_EQ(first.count(), all.count());
  EXPECT_EQ(first.max(), all.max());
  for (const double fraction : {0.0, 0.1, 0.5, 0.9, 0.99, 1.0})
    EXPECT_EQ(first.percentile(fraction), all.percentile(fraction)) << fraction;
}

TEST(Histogram, CountsNegativesAsZeroAndTheHugeInItsLastBucket) {
  Histogram histogram;
  histogram.add(Duration::us(-5));
  EXPECT_EQ(histogram.percentile(0.5), Duration());
  histogram.add(Duration::s(3600 * 24 * 365));
  EXPECT_GE(histogram.percentile(1.0), Duration::s(4000));
  EXPECT_EQ(histogram.max(), Duration::s(3600 * 24 * 365));
  histogram.clear();
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.percentile(1.0), Duration());
}

}  // namespace
}  // namespace dance
