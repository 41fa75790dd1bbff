#include "core/program/message_throttle.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

MonoTime at_s(int s) { return MonoTime::from_us(1'000'000) + Duration::s(s); }

TEST(MessageThrottle, SaysTheSameLineAgainAfterAMinute) {
  MessageThrottle throttle;
  EXPECT_TRUE(throttle.is_due("no answer", at_s(0)));
  EXPECT_FALSE(throttle.is_due("no answer", at_s(1)));
  EXPECT_FALSE(throttle.is_due("no answer", at_s(59)));
  EXPECT_TRUE(throttle.is_due("no answer", at_s(60)));
  EXPECT_FALSE(throttle.is_due("no answer", at_s(61)));
}

TEST(MessageThrottle, PassesANewLineAtOnceAlsoWhenLinesAlternate) {
  MessageThrottle throttle;
  for (int s = 0; s < 10; ++s)
    for (const char* line : {"no answer from a", "no answer from b"})
      EXPECT_EQ(throttle.is_due(line, at_s(s)), s == 0) << line << " at " << s;
}

TEST(MessageThrottle, SaysItAtOnceWhenAllWasWellBetween) {
  MessageThrottle throttle;
  EXPECT_TRUE(throttle.is_due("no answer", at_s(0)));
  throttle.forget();
  EXPECT_TRUE(throttle.is_due("no answer", at_s(1)));
}

TEST(MessageThrottle, KeepsAFewLinesOnly) {
  MessageThrottle throttle;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(throttle.is_due(std::to_string(i), at_s(0)));
  EXPECT_FALSE(throttle.is_due("999", at_s(1)));
  EXPECT_TRUE(throttle.is_due("0", at_s(1))) << "forgotten";
}

}  // namespace
}  // namespace dance
