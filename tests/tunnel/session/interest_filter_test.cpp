// Who wants what, and what therefore goes to whom.
#include "tunnel/session/interest_filter.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr std::uint32_t kStream = 5;

wire::Record pose_of(std::uint32_t sequence, bool is_intra = false, bool is_base = false) {
  wire::Record record;
  record.stream = kStream;
  record.sequence = sequence;
  record.is_intra = is_intra;
  record.is_base = is_base;
  return record;
}

// As a sender makes them: each 16th an intra frame, each second a base frame.
int count_taken(InterestFilter& filter, std::uint32_t poses) {
  int taken = 0;
  InterestFilter::Counts counts{0, 0, 1};
  for (std::uint32_t i = 0; i < poses; ++i) {
    const bool is_base = i % 2 == 0;
    if (is_base) ++counts.base_frames;
    taken += filter.take(pose_of(i, i % 16 == 0, is_base), counts) ? 1 : 0;
  }
  return taken;
}

TEST(InterestFilter, BeginsWithAnIntraFrameAndThenTakesAll) {
  InterestFilter filter;
  EXPECT_FALSE(filter.take(pose_of(1), {}));
  EXPECT_TRUE(filter.awaits_intra());
  EXPECT_TRUE(filter.take(pose_of(2, true), {}));
  EXPECT_TRUE(filter.take(pose_of(3), {}));
}

TEST(InterestFilter, TakesAsManyAsItsDividerAllows) {
  const std::pair<int, int> cases[] = {{0, 0},  {1, 160}, {2, 80}, {4, 40},
                                       {8, 20}, {16, 10}, {32, 5}};
  for (const auto& [divider, expected] : cases) {
    InterestFilter filter(static_cast<std::uint8_t>(divider));
    EXPECT_NEAR(count_taken(filter, 160), expected, 1) << divider;
  }
}

TEST(InterestFilter, MessagesPassUnlessNothingIsWantedAndHandsByTheirOwnCount) {
  wire::Record message;
  message.kind = wire::RecordKind::kChannel;
  wire::Record hands;
  hands.kind = wire::RecordKind::kHands;
  InterestFilter none(0);
  InterestFilter some(4);
  EXPECT_FALSE(none.take(message, {}));
  EXPECT_TRUE(some.take(message, {}));
  EXPECT_TRUE(some.take(hands, {0, 8, 0}));
  EXPECT_FALSE(some.take(hands, {0, 9, 0}));
}

TEST(InterestFilter, WhoComesToWantMoreNeedsAnIntraFrameUnlessItHasReferences) {
  InterestFilter filter(1);
  filter.take(pose_of(1, true), {});
  filter.frames().add(kStream, 1);
  EXPECT_FALSE(filter.set_divider(2, kStream)) << "it has what base frames refer to";
  EXPECT_FALSE(filter.awaits_intra());
  EXPECT_TRUE(filter.set_divider(1, kStream)) << "it lacks frames of between";
  EXPECT_TRUE(filter.awaits_intra());
  EXPECT_FALSE(filter.set_divider(20, kStream)) << "the next intra frame comes anyway";
  EXPECT_FALSE(filter.set_divider(0, kStream));
  EXPECT_TRUE(filter.set_divider(20, kStream)) << "it waits already";
  EXPECT_FALSE(filter.frames().is_of(kStream)) << "what it had is old";
}

TEST(InterestFilter, TellsHowManyWereLeftOutUntilTheReceiverHasTheWholeCount) {
  InterestFilter filter;
  for (std::uint32_t i = 1; i <= 3; ++i) EXPECT_FALSE(filter.take(pose_of(i), {}));
  wire::Record next = pose_of(4, true);
  EXPECT_TRUE(filter.take(next, {}));
  filter.tell_left_out(next);
  EXPECT_TRUE(next.counts_left_out);
  EXPECT_EQ(next.left_out, 3);
  filter.frames().add(kStream, 4);
  wire::Record later = pose_of(5);
  filter.tell_left_out(later);
  EXPECT_FALSE(later.counts_left_out);
}

wire::InterestList list_of(std::uint8_t default_divider) {
  wire::InterestList list;
  list.default_divider = default_divider;
  return list;
}

TEST(InterestRequest, IsToldUntilItsNewestVersionIsAcknowledged) {
  InterestRequest request;
  request.begin(1);
  EXPECT_TRUE(request.is_acked()) << "the hello has told it";
  EXPECT_FALSE(request.change(list_of(1)));
  EXPECT_TRUE(request.change(list_of(4)));
  EXPECT_FALSE(request.is_acked());
  const std::uint32_t version = request.list().version;
  EXPECT_TRUE(request.change(list_of(2)));
  request.take_ack(version);
  EXPECT_FALSE(request.is_acked()) << "an older one";
  request.take_ack(request.list().version);
  EXPECT_TRUE(request.is_acked());
}

TEST(InterestRequest, OvertakesAVersionThatTheServerTookForALaterOne) {
  InterestRequest request;
  request.begin(1);
  request.change(list_of(4));
  request.take_ack(1000);
  EXPECT_FALSE(request.is_acked());
  EXPECT_EQ(request.list().version, 1001u);
}

}  // namespace
}  // namespace dance
