// Who may dance under which name: taken names, guests who come with their first pose, and go with
// their producer.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

TEST(LocalGuests, ATakenNameIsRefusedByNameAndGetsItsTurnWhenItIsFree) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  auto& thief = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::s(1));
  EXPECT_FALSE(thief.link->is_connected());
  EXPECT_TRUE(thief.saw("refused 3 alice"));
  EXPECT_TRUE(a.link->is_connected());
  a.link->send_goodbye();
  a.is_running = false;
  tunnel.run(Duration::ms(1100));
  EXPECT_TRUE(thief.link->is_connected());
}

TEST(LocalGuests, ATakenNameKeepsNobodyElseOfTheHouseOut) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"ann"});
  tunnel.run(Duration::ms(100));
  auto& b = tunnel.add_house("salsa", {"alice", "ann"});
  Dance dance{tunnel, {{&b, guest("alice")}}};
  dance.run(Duration::s(1));
  EXPECT_TRUE(b.saw("refused 3 ann"));
  EXPECT_TRUE(b.link->is_connected());
  EXPECT_GE(a.heard_of(guest("alice")), 40u);
}

TEST(LocalGuests, EachOfSeveralTakenNamesGetsItsTurn) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"ann"});
  auto& c = tunnel.add_house("salsa", {"carl"});
  tunnel.run(Duration::ms(100));
  auto& b = tunnel.add_house("salsa", {"ann", "carl"});
  tunnel.run(Duration::s(2));
  EXPECT_TRUE(b.saw("refused 3 ann"));
  EXPECT_TRUE(b.saw("refused 3 carl"));
  EXPECT_FALSE(b.link->is_connected());
  const auto hellos = b.link->counters().hellos;
  tunnel.run(Duration::s(5));
  EXPECT_LE(b.link->counters().hellos, hellos + 12) << "at the pace of the tries";
  a.link->send_goodbye();
  a.is_running = false;
  tunnel.run(Duration::ms(1500));
  EXPECT_TRUE(b.link->is_connected());
  const auto before = c.heard_of(guest("ann"));
  Dance{tunnel, {{&b, guest("ann")}}}.run(Duration::s(1));
  EXPECT_GE(c.heard_of(guest("ann")), before + 40u);
}

TEST(LocalGuests, AHouseWhoseOnlyDancerLeftWhileTheNameWasTakenWatches) {
  SimulatedTunnel tunnel;
  tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  auto& b = tunnel.add_house("salsa", {});
  b.is_cut = true;
  Dance{tunnel, {{&b, guest("alice")}}}.run(Duration::ms(200));  // before it is connected
  b.is_cut = false;
  tunnel.run(Duration::s(3));
  EXPECT_FALSE(b.link->is_connected());
  tunnel.run(Duration::s(10));
  EXPECT_TRUE(b.link->is_connected());
}

TEST(LocalGuests, AGuestWhoCameWithAPoseGoesWithTheProducer) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  EXPECT_TRUE(b.saw("+alice"));
  tunnel.run(Duration::s(8));
  EXPECT_FALSE(b.saw("-alice")) << "a short break is none";
  tunnel.run(Duration::s(4));
  EXPECT_TRUE(b.saw("-alice"));
  EXPECT_TRUE(a.link->is_connected());
  EXPECT_FALSE(b.saw("-bob"));
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), 100u) << "and comes back";
}

TEST(LocalGuests, AGuestMayBeAddedByItsFirstPose) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  EXPECT_TRUE(b.saw("+alice"));
  EXPECT_FALSE(a.saw("+alice")) << "one's own guest is no news";
  EXPECT_GE(b.heard_of(guest("alice")), 55u);
}

TEST(LocalGuests, AnAddedGuestWhoseNameIsTakenIsRefusedAloneAndAskedForAgain) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}, {&b, guest("alice")}}};
  dance.run(Duration::s(1));
  EXPECT_TRUE(b.saw("refused 3 alice"));
  EXPECT_TRUE(b.link->is_connected());
  EXPECT_GT(a.heard_of(guest("bob")), 20u);
  EXPECT_GT(b.heard_of(guest("alice")), 20u) << "the other house's alice is heard all the same";
  a.link->send_goodbye();
  a.is_running = false;
  dance.run(Duration::s(2));
  auto& c = tunnel.add_house("salsa", {"carol"});
  dance.run(Duration::s(1));
  EXPECT_GT(c.heard_of(guest("alice")), 20u);
}

}  // namespace
}  // namespace dance
