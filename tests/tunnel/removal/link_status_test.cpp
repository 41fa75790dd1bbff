// What a window is told of the link, from what the link's handlers are called with.
#include "tunnel/link/link_status.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr MonoTime kStatusTime = MonoTime::from_us(9'000'000);

struct Told {
  Told() {
    handlers.on_state = [this](LinkState, MonoTime) { ++states; };
    status.listen_to(handlers);
    status.on_change([this] { ++changes; });
  }
  LinkHandlers handlers;
  LinkStatus status;
  int states = 0, changes = 0;
};

TEST(LinkStatus, SaysWhatIsWrongUntilTheLinkIsConnected) {
  Told told;
  told.handlers.on_no_answer(Address::loopback(7400));
  EXPECT_EQ(told.status.status().trouble, HouseLinkTrouble::kNoAnswer);
  told.handlers.on_no_entry(SealTrouble::kWrongKey);
  EXPECT_EQ(told.status.status().trouble, HouseLinkTrouble::kWrongKey);
  told.handlers.on_state(LinkState::kConnected, kStatusTime);
  EXPECT_EQ(told.status.status().trouble, HouseLinkTrouble::kNone);
  EXPECT_EQ(told.status.status().state, HouseLinkState::kConnected);
  told.handlers.on_state(LinkState::kLapsed, kStatusTime);
  EXPECT_EQ(told.status.status().state, HouseLinkState::kLapsed);
  EXPECT_EQ(told.states, 2) << "what the handler did before is done first";
  EXPECT_GE(told.changes, 4);
}

TEST(LinkStatus, NamesARefusalAndItsGuest) {
  Told told;
  wire::RefusalNotice refusal;
  refusal.cause = wire::Refusal::kNameTaken;
  refusal.guest = *GuestId::parse("bob");
  told.handlers.on_refused(refusal, kStatusTime);
  EXPECT_EQ(told.status.status().trouble, HouseLinkTrouble::kRefused);
  EXPECT_EQ(told.status.status().refusal, static_cast<int>(wire::Refusal::kNameTaken));
  EXPECT_EQ(told.status.status().refused.view(), "bob");
  refusal.cause = wire::Refusal::kRemoved;
  refusal.seconds = 600;
  told.handlers.on_refused(refusal, kStatusTime);
  EXPECT_EQ(told.status.status().trouble, HouseLinkTrouble::kRemoved);
  EXPECT_EQ(told.status.status().asks_again, kStatusTime + Duration::s(600));
  EXPECT_TRUE(is_valid(told.status.status()));
}

TEST(LinkStatus, TellsWhatBecameOfARemoval) {
  Told told;
  told.handlers.on_removal(4, RemovalVerdict::kAsked);
  told.handlers.on_removal(4, RemovalVerdict::kPassedOn);
  EXPECT_EQ(told.status.status().removal, 4);
  EXPECT_EQ(told.status.status().verdict, RemovalVerdict::kPassedOn);
}

}  // namespace
}  // namespace dance
