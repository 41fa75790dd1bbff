#include "core/base/plain_number.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(PlainNumber, HasTheDigitsThatItNeeds) {
  EXPECT_EQ(plain_number(10'000'000.0), "10000000");
  EXPECT_EQ(plain_number(0.25), "0.25");
  EXPECT_EQ(plain_number(-3.0), "-3");
  EXPECT_EQ(plain_number(86'400.5), "86400.5");
  EXPECT_EQ(plain_number(1e-5), "0.00001");
  // The least and the furthest numbers.
  EXPECT_EQ(plain_number(-5e-324).size(), 327u);
  EXPECT_EQ(plain_number(-1.7976931348623157e308).size(), 310u);
}

}  // namespace
}  // namespace dance
