#include "tunnel/policy/interest_wishes.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

const MonoTime kBegin = MonoTime::from_us(1'000'000);

GuestId guest_named(std::string_view name) { return *GuestId::parse(name); }

InterestWish hides(std::uint64_t viewer, std::initializer_list<const char*> names = {}) {
  InterestWish wish;
  wish.viewer = viewer;
  std::size_t i = 0;
  for (const char* name : names) wish.hidden[i++] = guest_named(name);
  return wish;
}

// Where nothing plays voices.
int wished_divider(const InterestWishes& wishes, const char* name, const Interest& own = {}) {
  return wishes.within(own, {false, {}}).divider_of(guest_named(name));
}

TEST(InterestWishes, LeaveOutWhomAllWindowsHide) {
  InterestWishes wishes;
  EXPECT_EQ(wished_divider(wishes, "bob"), 1) << "nobody says anything";
  wishes.hear(hides(1, {"bob", "dora"}), kBegin);
  EXPECT_EQ(wished_divider(wishes, "bob"), 0);
  wishes.hear(hides(2), kBegin);
  EXPECT_EQ(wished_divider(wishes, "bob"), 1) << "the other window shows everybody";
  wishes.hear(hides(2, {"bob"}), kBegin);
  EXPECT_EQ(wished_divider(wishes, "bob"), 0);
  EXPECT_EQ(wished_divider(wishes, "dora"), 1);
  wishes.hear(hides(1), kBegin);
  EXPECT_EQ(wished_divider(wishes, "bob"), 1) << "shown again";
}

TEST(InterestWishes, OfAWindowThatHasDiedHoldNoLonger) {
  InterestWishes wishes;
  wishes.hear(hides(1, {"bob"}), kBegin);
  EXPECT_FALSE(wishes.expire(kBegin + InterestWishes::kHolds));
  EXPECT_TRUE(wishes.expire(kBegin + InterestWishes::kHolds + Duration::ms(1)));
  EXPECT_EQ(wished_divider(wishes, "bob"), 1);
  EXPECT_FALSE(wishes.expire(kBegin + InterestWishes::kHolds + Duration::s(9)));
}

TEST(InterestWishes, HideNobodyWhileThereAreMoreWindowsThanPlaces) {
  InterestWishes wishes;
  for (std::uint64_t viewer = 1; viewer <= InterestWishes::kMostViewers; ++viewer)
    wishes.hear(hides(viewer, {"bob"}), kBegin);
  EXPECT_EQ(wished_divider(wishes, "bob"), 0);
  wishes.hear(hides(77), kBegin + Duration::s(1));
  EXPECT_EQ(wished_divider(wishes, "bob"), 1) << "it may show bob";
  for (std::uint64_t viewer = 1; viewer <= InterestWishes::kMostViewers; ++viewer)
    wishes.hear(hides(viewer, {"bob"}), kBegin + Duration::s(4));
  EXPECT_EQ(wished_divider(wishes, "bob"), 1);
  EXPECT_TRUE(wishes.expire(kBegin + Duration::ms(6'001)));
  EXPECT_EQ(wished_divider(wishes, "bob"), 0) << "that one has ended";
}

TEST(InterestWishes, StayWithinWhatTheHouseWantsAndKeepWhoIsHeard) {
  Interest own;
  own.others = 4;
  ASSERT_TRUE(own.guests.try_push({guest_named("alice"), 0}) &&
              own.guests.try_push({guest_named("bob"), 1}));
  InterestWishes wishes;
  wishes.hear(hides(1, {"alice", "bob", "carol", "dora"}), kBegin);
  Hearing voices{false, {}};
  ASSERT_TRUE(voices.exceptions.try_push(guest_named("dora")));
  const Interest wanted = wishes.within(own, voices);
  EXPECT_EQ(wanted.divider_of(guest_named("alice")), 0);
  EXPECT_EQ(wanted.divider_of(guest_named("bob")), 0);
  EXPECT_EQ(wanted.divider_of(guest_named("carol")), 0);
  EXPECT_EQ(wanted.divider_of(guest_named("dora")), InterestWishes::kFewest) << "hidden, and heard";
  EXPECT_EQ(wanted.divider_of(guest_named("emil")), 4);
  EXPECT_EQ(wanted.guests.size(), 4u);
  own.others = 0;
  EXPECT_EQ(wishes.within(own, voices).divider_of(guest_named("dora")), 0)
      << "nobody asked for dora";
}

}  // namespace
}  // namespace dance
