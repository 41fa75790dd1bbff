#include "apps/crowd/crowd_board.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

MonoTime time_of(std::uint32_t sequence) { return MonoTime::from_us(1000 + sequence); }

TEST(CrowdBoard, KnowsWhenNewPosesWereSentAndForgetsOldOnes) {
  CrowdBoard board(2);
  constexpr std::uint32_t kPoses = 2000;
  for (std::uint32_t sequence = 1; sequence <= kPoses; ++sequence) {
    board.note(1, sequence, time_of(sequence));
    // Somebody may hear it before it is published.
    EXPECT_EQ(board.sent_at(1, sequence), time_of(sequence));
    board.publish(1, sequence);
  }
  EXPECT_EQ(board.newest(1), kPoses);
  EXPECT_EQ(board.newest(0), 0u);
  EXPECT_EQ(board.sent_at(1, kPoses), time_of(kPoses));
  EXPECT_EQ(board.sent_at(1, kPoses - 500), time_of(kPoses - 500));
  EXPECT_FALSE(board.sent_at(1, kPoses - CrowdBoard::kKept).is_set());
  EXPECT_FALSE(board.sent_at(1, 1).is_set());
  EXPECT_FALSE(board.sent_at(1, kPoses + 2).is_set());
  EXPECT_FALSE(board.sent_at(0, 1).is_set());
}

}  // namespace
}  // namespace dance
