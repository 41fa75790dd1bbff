// What has come, and when the other side is told.
#include "tunnel/session/ack_tracker.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr MonoTime kSentTime = MonoTime::from_us(5'000'000);

AckTracker::Slots slots_of(std::initializer_list<std::uint8_t> slots) {
  AckTracker::Slots list;
  for (const std::uint8_t slot : slots) EXPECT_TRUE(list.try_push(slot));
  return list;
}

TEST(AckTracker, TellsNothingBeforeSomethingCame) {
  const AckTracker tracker;
  wire::RecordsHeader header;
  tracker.fill(header);
  EXPECT_FALSE(header.has_acks);
  EXPECT_FALSE(tracker.is_ripe(kSentTime, false));
}

TEST(AckTracker, ExceptsTheGuestsWhosePosesDidNotDecode) {
  AckTracker tracker;
  tracker.note(10);
  EXPECT_TRUE(tracker.note_except(11, slots_of({3, 5})));
  tracker.note(12);
  wire::RecordsHeader header;
  tracker.fill(header);
  ASSERT_TRUE(header.has_acks);
  EXPECT_EQ(header.acks.newest, 12);
  EXPECT_EQ(header.acks.before & 3, 3u) << "10 and 11 came";
  ASSERT_EQ(header.acks.excepts.size(), 2u);
  EXPECT_EQ(header.acks.excepts[0].back, 1);
  EXPECT_EQ(header.acks.excepts[0].slot, 3);
  EXPECT_EQ(header.acks.excepts[1].slot, 5);
}

TEST(AckTracker, WhereMoreFailThanCanBeToldTheOthersAreAcknowledgedStill) {
  AckTracker tracker;
  for (std::uint16_t number = 0; number < wire::kMaxAckExcepts; ++number)
    EXPECT_TRUE(tracker.note_except(number, slots_of({1})));
  EXPECT_TRUE(tracker.note_except(wire::kMaxAckExcepts, slots_of({1})));
  wire::RecordsHeader header;
  tracker.fill(header);
  EXPECT_EQ(header.acks.newest, wire::kMaxAckExcepts);
  EXPECT_EQ(header.acks.before, 0u) << "what was seen before is not acknowledged without excepts";
  EXPECT_EQ(header.acks.excepts.size(), 1u);
}

TEST(AckTracker, IsDueWhenItWasPromisedOrAtOnceAfterSixteenDatagrams) {
  AckTracker tracker;
  tracker.owe(kSentTime + Duration::ms(20), false, kSentTime);
  tracker.owe(kSentTime + Duration::ms(30), false, kSentTime);
  EXPECT_EQ(tracker.due(), kSentTime + Duration::ms(20)) << "the first promise counts";
  for (int i = 2; i < 15; ++i) tracker.owe(kSentTime + Duration::ms(30), false, kSentTime);
  EXPECT_EQ(tracker.due(), kSentTime + Duration::ms(20));
  tracker.owe(kSentTime + Duration::ms(30), false, kSentTime);
  EXPECT_EQ(tracker.due(), kSentTime);
}

TEST(AckTracker, OnACleanPathItIsDueLaterButGoesAlongOnceMuchHasCome) {
  AckTracker tracker;
  tracker.note(1);
  wire::RecordsHeader header;
  tracker.tell(header, kSentTime);
  const MonoTime soon = kSentTime + Duration::ms(10), promised = kSentTime + Duration::ms(40);
  for (int i = 0; i < 15; ++i) tracker.owe(promised, true, soon);
  EXPECT_FALSE(tracker.is_ripe(soon, true));
  tracker.owe(promised, true, soon);
  EXPECT_TRUE(tracker.is_ripe(soon, true)) << "with a pose that leaves anyway";
  EXPECT_EQ(tracker.due(), promised) << "but not alone";
  for (int i = 16; i < 31; ++i) tracker.owe(promised, true, soon);
  EXPECT_EQ(tracker.due(), soon) << "before the first of them are beyond what it tells of";
}

TEST(AckTracker, GoesAlongAtOnceOnAPathThatLosesAndWaitsOnACleanOne) {
  AckTracker tracker;
  tracker.note(1);
  wire::RecordsHeader header;
  tracker.tell(header, kSentTime);
  EXPECT_FALSE(tracker.owes());
  tracker.owe(kSentTime + Duration::ms(40), false, kSentTime);
  const MonoTime soon = kSentTime + Duration::ms(10);
  EXPECT_TRUE(tracker.is_ripe(soon, false));
  EXPECT_FALSE(tracker.is_ripe(soon, true));
  EXPECT_TRUE(tracker.is_ripe(kSentTime + AckTracker::kCleanGap, true));
}

TEST(AckTracker, AnIntraFrameIsAskedForOnceAndAtOnce) {
  AckTracker tracker;
  EXPECT_TRUE(tracker.want_intra_frame(9, kSentTime));
  EXPECT_TRUE(tracker.is_ripe(kSentTime, true));
  wire::RecordsHeader header;
  tracker.tell(header, kSentTime);
  ASSERT_EQ(header.wants.size(), 1u);
  EXPECT_EQ(header.wants[0], 9);
  wire::RecordsHeader next;
  tracker.tell(next, kSentTime);
  EXPECT_TRUE(next.wants.empty());
}

TEST(AckTracker, RefusesMoreRequestsThanADatagramHolds) {
  AckTracker tracker;
  for (std::uint8_t slot = 0; slot < wire::kMaxWants; ++slot)
    EXPECT_TRUE(tracker.want_intra_frame(slot, kSentTime));
  EXPECT_FALSE(tracker.want_intra_frame(wire::kMaxWants, kSentTime));
}

}  // namespace
}  // namespace dance
