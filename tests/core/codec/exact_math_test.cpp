#include "core/codec/exact/exact_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/base/random.h"

namespace dance {
namespace {

TEST(ExactMath, SinAndCosAreNearTheTruth) {
  Random random(1);
  for (const double reach : {0.8, 3.2, 100.0}) {
    for (int i = 0; i < 200'000; ++i) {
      const double x = random.uniform(-reach, reach);
      ASSERT_NEAR(exact::sin(x), std::sin(x), 1e-13) << x;
      ASSERT_NEAR(exact::cos(x), std::cos(x), 1e-13) << x;
    }
  }
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.uniform(-1e6, 1e6);
    ASSERT_NEAR(exact::sin(x), std::sin(x), 1e-9) << x;
    ASSERT_NEAR(exact::cos(x), std::cos(x), 1e-9) << x;
  }
  EXPECT_EQ(exact::sin(0.0), 0.0);
  EXPECT_EQ(exact::cos(0.0), 1.0);
}

TEST(ExactMath, Atan2IsNearTheTruthInEveryQuadrant) {
  Random random(2);
  for (int i = 0; i < 500'000; ++i) {
    const double scale = std::exp2(random.uniform(-300.0, 300.0));
    const double y = scale * random.normal();
    const double x = scale * random.normal() * std::exp2(random.uniform(-30.0, 30.0));
    ASSERT_NEAR(exact::atan2(y, x), std::atan2(y, x), 1e-14) << y << " " << x;
  }
  for (const double y : {-1.0, 0.0, 1.0})
    for (const double x : {-1.0, 0.0, 1.0})
      EXPECT_NEAR(exact::atan2(y, x), std::atan2(y, x), 1e-14) << y << " " << x;
}

TEST(ExactMath, Exp2AndLog2AreNearTheTruth) {
  Random random(3);
  for (int i = 0; i < 500'000; ++i) {
    const double x = random.uniform(-1022.0, 1023.4);
    ASSERT_NEAR(exact::exp2(x) / std::exp2(x), 1.0, 1e-13) << x;
    const double v = std::exp2(random.uniform(-1074.0, 1023.9));
    ASSERT_NEAR(exact::log2(v), std::log2(v), 5e-13) << v;
    const double near = random.uniform(0.5, 2.0);
    ASSERT_NEAR(exact::log2(near), std::log2(near), 1e-14) << near;
  }
  for (int n = -1022; n <= 1023; ++n) {
    EXPECT_EQ(exact::exp2(n), std::ldexp(1.0, n));
    EXPECT_EQ(exact::log2(std::ldexp(1.0, n)), n);
  }
  EXPECT_EQ(exact::exp2(-1e9), 0.0);
  EXPECT_EQ(exact::exp2(1e9), HUGE_VAL);
}

// Every build gives these bits; otherwise two ends cannot decode each other.
TEST(ExactMath, GivesTheSameBitsEverywhere) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto add = [&hash](double v) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 0x100000001b3ULL;
  };
  Random random(4);
  for (int i = 0; i < 100'000; ++i) {
    add(exact::sin(random.uniform(-10.0, 10.0)));
    add(exact::cos(random.uniform(-10.0, 10.0)));
    const double y = random.uniform(-1.0, 1.0);
    add(exact::atan2(y, random.uniform(-1.0, 1.0)));
    add(exact::exp2(random.uniform(-40.0, 40.0)));
    add(exact::log2(random.uniform(0.001, 1000.0)));
  }
  EXPECT_EQ(hash, 0xf2794ea2fe46a2eeULL);
}

}  // namespace
}  // namespace dance
