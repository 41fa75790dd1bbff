// When poses go once more, and which one does.
#include "tunnel/session/repetition.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(RepetitionStrategy, BeginsAboveHalfAPercentAndEndsWhenNearlyNothingIsLost) {
  Repetition repetition;
  LossMeter way;
  for (int i = 0; i < 2000; ++i) way.add(false);
  repetition.update(way);
  EXPECT_FALSE(repetition.is_on());
  for (int i = 0; i < 2000; ++i) way.add(i % 50 == 0);
  repetition.update(way);
  EXPECT_TRUE(repetition.is_on());
  EXPECT_LT(repetition.residual(way), way.loss()) << "only what is lost twice in a row";
  for (int i = 0; i < 20'000; ++i) way.add(i % 1000 == 0);
  repetition.update(way);
  EXPECT_FALSE(repetition.is_on());
  EXPECT_EQ(repetition.residual(way), way.loss());
}

wire::Record pose_of(std::uint32_t sequence, wire::Bytes payload) {
  wire::Record record;
  record.slot = 3;
  record.stream = 5;
  record.sequence = sequence;
  record.sent_age_us = 900;
  record.payload = payload;
  return record;
}

TEST(SentPose, GoesOnceMoreInFrontOfTheNextOfItsStreamOnly) {
  std::array<std::uint8_t, 3> payload{1, 2, 3};
  SentPose sent;
  EXPECT_FALSE(sent.is_before(pose_of(1, payload))) << "none yet";
  sent.keep(pose_of(7, payload));
  payload = {};
  EXPECT_TRUE(sent.is_before(pose_of(8, payload)));
  EXPECT_FALSE(sent.is_before(pose_of(9, payload)));
  wire::Record other = pose_of(8, payload);
  other.stream = 6;
  EXPECT_FALSE(sent.is_before(other));
  const wire::Record again = sent.again();
  EXPECT_EQ(again.sequence, 7u);
  EXPECT_EQ(again.sent_age_us, wire::kNoAge) << "how it travelled is told once";
  ASSERT_EQ(again.payload.size(), 3u);
  EXPECT_EQ(again.payload[2], 3) << "its own copy";
}

}  // namespace
}  // namespace dance
