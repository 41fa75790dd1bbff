#include "core/base/sequence.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(Sequence, CountsForwardsAndBackwards) {
  EXPECT_EQ(sequence_ahead(10, 13), 3);
  EXPECT_EQ(sequence_ahead(13, 10), -3);
  EXPECT_TRUE(is_newer_sequence(13, 10));
  EXPECT_FALSE(is_newer_sequence(10, 13));
}

TEST(Sequence, IsNotNewerThanItself) { EXPECT_FALSE(is_newer_sequence(7, 7)); }

TEST(Sequence, WrapsAtThirtyTwoBits) {
  EXPECT_TRUE(is_newer_sequence(0, 0xffffffffu));
  EXPECT_FALSE(is_newer_sequence(0xffffffffu, 0));
  EXPECT_EQ(sequence_ahead(0xfffffffeu, 3), 5);
  EXPECT_EQ(sequence_ahead(3, 0xfffffffeu), -5);
}

TEST(Sequence, IsRightUpToHalfTheRange) {
  EXPECT_TRUE(is_newer_sequence(0x7fffffffu, 0));
  EXPECT_FALSE(is_newer_sequence(0x80000001u, 0));
}

}  // namespace
}  // namespace dance
