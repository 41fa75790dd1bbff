// What a newcomer sees of those who do not move just now.
#include <gtest/gtest.h>

#include "core/pose/skeleton.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

class Kept : public ::testing::Test {
 protected:
  Kept() {
    a = &tunnel.add_house("salsa", {"alice"});
    tunnel.add_house("salsa", {"bob"});
    a->link->send(guest("alice"), average_skeleton(1.58f), tunnel.time_in(*a));
    Dance{tunnel, {{a, guest("alice")}}}.run(Duration::s(4));
  }
  // Hello and answer, 5 ms each.
  static constexpr Duration kRoundTrip = Duration::ms(1 + 10);

  SimulatedTunnel tunnel;
  House* a = nullptr;
};

TEST_F(Kept, ADancerWhoStoppedIsOnANewcomersStageWithinARoundTrip) {
  const MonoTime stopped = tunnel.now();
  for (const Duration pause : {Duration::s(1), Duration::s(300)}) {
    tunnel.run(pause);
    House& c = tunnel.add_house("salsa", {}, Duration::s(77));
    tunnel.run(kRoundTrip);
    ASSERT_EQ(c.heard_of(guest("alice")), 1u);
    ASSERT_EQ(c.skeletons.size(), 1u) << "with the proportions";
    const Pose& pose = c.poses[0].pose;
    EXPECT_EQ(pose.clock_id, c.clock_id);
    const MonoTime captured = pose.capture_time - c.clock_ahead;
    EXPECT_LE(captured, stopped);
    EXPECT_GE(captured, stopped - Duration::ms(2600)) << "not much older than what others saw";
    tunnel.run(Duration::s(1));
    EXPECT_EQ(c.heard_of(guest("alice")), 1u) << "once: it is acknowledged";
    EXPECT_EQ(c.link->remote_stats().at(0).lost, 0u);
    c.link->send_goodbye();
    c.is_running = false;
  }
}

TEST_F(Kept, ANewcomerIsToldRosterStatesAndPosesInThisOrder) {
  Music music;
  music.clock_id = a->clock_id;
  a->link->send(guest("alice"), music, tunnel.time_in(*a));
  tunnel.run(Duration::ms(50));
  std::vector<wire::Type> told;
  House* c = nullptr;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto type = wire::parse_opening(bytes)->type;
    const bool is_new = told.empty() || told.back() != type;
    if (!to_server && c != nullptr && peer == c->peer && is_new) told.push_back(type);
    return true;
  };
  c = &tunnel.add_house("salsa", {});
  tunnel.run(kRoundTrip);
  EXPECT_EQ(told, (std::vector<wire::Type>{wire::Type::kWelcome, wire::Type::kRoster,
                                           wire::Type::kState, wire::Type::kRecords}));
  EXPECT_EQ(c->heard_of(guest("alice")), 1u);
  EXPECT_EQ(c->skeletons.size(), 1u);
  EXPECT_TRUE(c->music.has_value());
}

TEST_F(Kept, ADancerWhoseLineIsDownIsThereToo) {
  a->is_cut = true;
  Dance{tunnel, {{a, guest("alice")}}}.run(Duration::s(1));
  House& c = tunnel.add_house("salsa", {"carol"});
  tunnel.run(kRoundTrip);
  EXPECT_EQ(c.heard_of(guest("alice")), 1u);
}

TEST_F(Kept, WhatDancesOnIsNoLossAndNeverOlderThanBefore) {
  House& c = tunnel.add_house("salsa", {"carol"});
  Dance dance{tunnel, {{a, guest("alice")}}};
  dance.run(Duration::s(2));
  const auto check = [&] {
    for (std::size_t i = 1; i < c.poses.size(); ++i) {
      EXPECT_GT(c.poses[i].pose.capture_time, c.poses[i - 1].pose.capture_time) << i;
      EXPECT_GT(c.poses[i].pose.sequence, c.poses[i - 1].pose.sequence) << i;
    }
    EXPECT_EQ(c.link->remote_stats().at(0).lost, 0u);
    EXPECT_EQ(c.link->counters().reference_missing, 0u);
  };
  check();
  // Through another sealed session: what is retained is older than what the stage has seen.
  const auto before = c.poses.size();
  tunnel.seal_anew(c);
  dance.run(Duration::s(1));
  EXPECT_GE(c.poses.size(), before + 50);
  check();
}

TEST_F(Kept, IsSaidAgainWhereItWasLostOrCameBeforeTheSkeleton) {
  tunnel.run(Duration::s(1));
  for (const wire::Type lost : {wire::Type::kRecords, wire::Type::kState, wire::Type::kRoster}) {
    House& c = tunnel.add_house("salsa", {});
    const MonoTime until = tunnel.now() + Duration::ms(100);
    tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
      return to_server || peer != c.peer || tunnel.now() > until ||
             wire::parse_opening(bytes)->type != lost;
    };
    tunnel.run(Duration::ms(90));
    EXPECT_EQ(c.heard_of(guest("alice")), 0u);
    tunnel.run(Duration::ms(200));
    EXPECT_EQ(c.heard_of(guest("alice")), 1u) << static_cast<int>(lost);
    tunnel.on_datagram = {};
    c.link->send_goodbye();
    c.is_running = false;
  }
}

TEST_F(Kept, WhoWantsNothingGetsNothingAndWhoWantsLaterGetsIt) {
  tunnel.run(Duration::s(1));
  tunnel.link_options.interest.others = 0;
  House& c = tunnel.add_house("salsa", {});
  tunnel.run(Duration::s(1));
  EXPECT_EQ(c.heard_of(guest("alice")), 0u);
  c.link->set_interest({}, tunnel.time_in(c));
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(c.heard_of(guest("alice")), 1u);
}

TEST_F(Kept, WhoWantsSomebodyAgainSeesWhereTheDanceHasEnded) {
  House& c = tunnel.add_house("salsa", {});
  Dance dance{tunnel, {{a, guest("alice")}}};
  dance.run(Duration::s(1));
  Interest nobody;
  nobody.others = 0;
  c.link->set_interest(nobody, tunnel.time_in(c));
  dance.run(Duration::s(4));
  const auto before = c.poses.size();
  c.link->set_interest({}, tunnel.time_in(c));
  tunnel.run(Duration::ms(300));
  ASSERT_EQ(c.poses.size(), before + 1);
  EXPECT_GE(tunnel.now() - c.poses.back().pose.capture_time, Duration::ms(300));
  EXPECT_LE(tunnel.now() - c.poses.back().pose.capture_time, Duration::ms(300 + 2600));
  EXPECT_EQ(c.link->remote_stats().at(0).lost, 0u);
}

TEST_F(Kept, IsGoneWithItsGuest) {
  a->link->send_goodbye();
  tunnel.run(Duration::ms(50));
  tunnel.start_link(*a, "salsa", {"anna"});
  tunnel.run(Duration::ms(200));
  House& c = tunnel.add_house("salsa", {});
  tunnel.run(Duration::ms(500));
  EXPECT_TRUE(c.saw("+anna"));
  EXPECT_TRUE(c.poses.empty()) << "nothing of who had the slot before";
}

}  // namespace
}  // namespace dance
