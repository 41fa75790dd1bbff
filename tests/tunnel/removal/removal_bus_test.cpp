// Tests a removal from the host's REMOVAL/local on its house's socket to HOUSE_LINK/local on the
// bus of the removed house.
#include "tests/tunnel/removal/two_houses.h"

namespace dance {
namespace {

using RemovalBus = RemovalHouses;

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

TEST_F(RemovalBus, IgnoresRequestsOnTheBusAndRequestsOfGuests) {
  const auto removal = [](std::int32_t number, const char* guest) {
    return Removal{mono_now(), this_clock_id(), number, named(guest)};
  };
  host_->viewer->publish(Channel::of_house(Signal::kRemoval), removal(7, "bob"));
  bob_->ask(removal(8, "hanna"));
  ASSERT_TRUE(turn_until([&] { return bob_->status.verdict == RemovalVerdict::kNotAllowed; }));
  host_->ask(removal(9, "nobody"));
  ASSERT_TRUE(turn_until([&] { return host_->status.verdict == RemovalVerdict::kNoSuchGuest; }));
  EXPECT_EQ(host_->status.removal, 9) << "the request on the bus was taken";
  EXPECT_EQ(server_->core().guest_count(), 2u);
}

TEST_F(RemovalBus, ReportsAServersGoodbyeAsAClosedRoom) {
  server_->send_goodbye();
  server_.reset();
  ASSERT_TRUE(turn_until([&] { return bob_->status.trouble == HouseLinkTrouble::kClosed; }));
  EXPECT_EQ(bob_->status.state, HouseLinkState::kLapsed);
  bool has_answer_failed = false;
  const MonoTime end = mono_now() + Duration::ms(1500);
  while (mono_now() < end) {
    poller_->run_once(Duration::ms(5));
    has_answer_failed = has_answer_failed || bob_->status.trouble != HouseLinkTrouble::kClosed;
  }
  EXPECT_FALSE(has_answer_failed) << "silence afterwards is reported as no other error";
}

}  // namespace
}  // namespace dance
