#include "core/base/result.h"

#include <gtest/gtest.h>

#include <memory>

#include "core/base/assert.h"

namespace dance {
namespace {

Result<std::unique_ptr<int>> make(int value) {
  if (value < 0) return fail("value " + std::to_string(value) + " is negative: give another");
  return std::make_unique<int>(value);
}

Result<int> add(int a, int b, int& tried) {
  DANCE_TRY(const auto first, make(a));
  ++tried;
  DANCE_TRY(auto second, make(b));
  ++tried;
  return *first + *second;
}

TEST(Result, TryTakesTheValueEvenWhenItCanOnlyMove) {
  int tried = 0;
  const Result<int> sum = add(2, 3, tried);
  ASSERT_TRUE(sum.has_value());
  EXPECT_EQ(*sum, 5);
  EXPECT_EQ(tried, 2);
}

TEST(Result, TryReturnsTheFirstErrorUnchanged) {
  int tried = 0;
  const Result<int> sum = add(2, -3, tried);
  ASSERT_FALSE(sum.has_value());
  EXPECT_EQ(sum.error().what, "value -3 is negative: give another");
  EXPECT_EQ(tried, 1);
  EXPECT_FALSE(add(-1, -1, tried).has_value());
  EXPECT_EQ(tried, 1);
}

TEST(AssertDeathTest, NamesConditionAndValues) {
  EXPECT_DEATH(DANCE_ASSERT(1 + 1 == 3), "assertion failed: 1 \\+ 1 == 3");
  EXPECT_DEATH(DANCE_ASSERT(false, 4, 5.5), "assertion failed: false \\[4, 5.5\\]");
}

TEST(Assert, EvaluatesItsConditionOnce) {
  int evaluated = 0;
  DANCE_ASSERT(++evaluated > 0);
  EXPECT_EQ(evaluated, 1);
}

}  // namespace
}  // namespace dance
