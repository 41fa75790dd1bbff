// From REMOVAL/local on a host's bus to HOUSE_LINK/local on the bus of the house that is removed.
#include "tests/tunnel/removal/two_houses.h"

namespace dance {
namespace {

using RemovalBus = TwoHouses;

TEST_F(RemovalBus, AHostsWindowRemovesAGuestAndBothHousesAreTold) {
  EXPECT_FALSE(bob_->status.may_remove);
  host_->ask({mono_now(), this_clock_id(), 5, named("bob")});
  ASSERT_TRUE(turn_until([&] { return host_->status.verdict == RemovalVerdict::kDone; }));
  EXPECT_EQ(host_->status.removal, 5);
  ASSERT_TRUE(turn_until([&] { return bob_->status.trouble == HouseLinkTrouble::kRemoved; }));
  EXPECT_EQ(bob_->status.state, HouseLinkState::kConnecting);
  EXPECT_GT(bob_->status.asks_again - mono_now(), Duration::s(560));
  EXPECT_EQ(bob_->line,
            "a host has removed this house from room 'salsa': it asks again in 10 minutes, and no "
            "earlier; ask the host");
  EXPECT_EQ(server_->core().guest_count(), 1u);
}

TEST_F(RemovalBus, WhatARecordingOrAGuestSaysRemovesNobody) {
  host_->ask({mono_now(), this_clock_id() + 1, 6, named("bob")});  // of another house's clock
  host_->ask({mono_now() - Duration::s(60), this_clock_id(), 7, named("bob")});
  bob_->ask({mono_now(), this_clock_id(), 8, named("hanna")});
  ASSERT_TRUE(turn_until([&] { return bob_->status.verdict == RemovalVerdict::kNotAllowed; }));
  host_->ask({mono_now(), this_clock_id(), 9, named("nobody")});
  ASSERT_TRUE(turn_until([&] { return host_->status.verdict == RemovalVerdict::kNoSuchGuest; }));
  EXPECT_EQ(host_->status.removal, 9) << "the others were not obeyed";
  EXPECT_EQ(server_->core().guest_count(), 2u);
}

}  // namespace
}  // namespace dance
