// Links that want less than all: who gets what, that it decodes, and what it costs the others.
#include <gtest/gtest.h>

#include "core/pose/skeleton.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/policy/pose_share.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

Interest wanting(const std::vector<std::string>& words) {
  const auto interest = parse_interest(words);
  EXPECT_TRUE(interest);
  return *interest;
}

TEST(Interest, IsRoundedToPowersOfTwoAndNeverToMore) {
  for (unsigned divider = 2; divider <= 128; ++divider)
    EXPECT_GE(1u << spacing_log2(static_cast<std::uint8_t>(divider)), divider);
  EXPECT_EQ(spacing_log2(2), 1);
  EXPECT_EQ(spacing_log2(3), 2);
  EXPECT_EQ(spacing_log2(8), 3);
  EXPECT_EQ(spacing_log2(9), 4);
  EXPECT_EQ(spacing_log2(255), kFewestIntra_log2);
}

class InterestRoom : public ::testing::Test {
 protected:
  House& add(const std::string& name, const std::vector<std::string>& want = {}) {
    tunnel.link_options.interest = wanting(want);
    House& house = tunnel.add_house("salsa", {name});
    house.link->send(guest(name), average_skeleton(1.7f), tunnel.time_in(house));
    return house;
  }
  void set(House& house, const std::vector<std::string>& want) {
    house.link->set_interest(wanting(want), tunnel.time_in(house));
  }
  // Of the next seconds: what of alice came to a house and could be shown.
  struct Share {
    double poses_per_s;
    double decodable;
    std::uint64_t lost;
  };
  Share share_of_alice(House& house, Dance& dance, int seconds) {
    const auto of_alice = [&] {
      for (const RemoteGuestStats& stats : house.link->remote_stats())
        if (stats.guest == guest("alice")) return stats;
      return RemoteGuestStats{};
    };
    const auto before = of_alice();
    const auto heard = house.heard_of(guest("alice"));
    dance.run(Duration::s(seconds));
    const auto after = of_alice();
    const auto shown = static_cast<double>(house.heard_of(guest("alice")) - heard);
    const auto received = static_cast<double>(after.received - before.received);
    return {shown / seconds, received > 0 ? shown / received : 1.0, after.lost - before.lost};
  }

  SimulatedTunnel tunnel;
};

TEST_F(InterestRoom, EachGetsWhatItWantsAndAllOfItDecodesAndNothingCountsAsLost) {
  House& a = add("alice");
  House& all = add("bob");
  House& half = add("carol", {"alice=2"});
  House& third = add("dora", {"alice=3"});
  House& eighth = add("emil", {"default=8"});
  House& few = add("fred", {"default=30"});
  House& none = add("gerda", {"alice=0"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&all, guest("bob")}}};
  dance.run(Duration::s(1));
  struct Expected {
    House* house;
    double least, most;
  };
  for (const auto& [house, least, most] :
       {Expected{&all, 62, 63}, Expected{&half, 30, 32}, Expected{&third, 15, 16},
        Expected{&eighth, 7, 8.1}, Expected{&few, 1.7, 2.1}, Expected{&none, 0, 0}}) {
    const Share share = share_of_alice(*house, dance, 4);
    EXPECT_GE(share.poses_per_s, least);
    EXPECT_LE(share.poses_per_s, most);
    EXPECT_GE(share.decodable, 0.99);
    EXPECT_EQ(share.lost, 0u);
  }
  EXPECT_GE(half.heard_of(guest("bob")), 60u * 20) << "of others it wants all";
  for (House* house : {&all, &half, &third, &eighth, &few})
    EXPECT_EQ(house->link->counters().reference_missing, 0u);
}

TEST_F(InterestRoom, WhatIsLostOnTheWayIsCountedAndWhatWasLeftOutIsNot) {
  House& a = add("alice");
  add("bob");
  House& half = add("carol", {"alice=2"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  std::uint64_t dropped = 0;
  Random random(9);
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (to_server || peer != half.peer || opening->type != wire::Type::kRecords) return true;
    ByteReader in(opening->body);
    if (!wire::parse_records_header(in)->has_records || random.uniform() >= 0.1) return true;
    ++dropped;
    return false;
  };
  const Share lossy = share_of_alice(half, dance, 10);
  tunnel.on_datagram = {};
  dance.run(Duration::ms(100));
  EXPECT_GT(dropped, 15u);
  EXPECT_NEAR(static_cast<double>(lossy.lost), static_cast<double>(dropped), 2.0);
  EXPECT_GE(lossy.decodable, 0.99) << "what arrives refers only to what has arrived";
}

TEST_F(InterestRoom, AChangedMindTakesARoundTripAndEachChangeDecodes) {
  House& a = add("alice");
  add("bob");
  House& c = add("carol");
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  std::uint64_t lost = 0;
  const auto change = [&](const std::vector<std::string>& want) {
    set(c, want);
    dance.run(Duration::ms(300));
    const Share share = share_of_alice(c, dance, 2);
    EXPECT_GE(share.decodable, 0.99);
    lost += share.lost;
    return share.poses_per_s;
  };
  EXPECT_NEAR(change({"alice=2"}), 31, 1);
  EXPECT_NEAR(change({"alice=4"}), 15.5, 1);
  EXPECT_EQ(change({"alice=0"}), 0);
  EXPECT_NEAR(change({"alice=2"}), 31, 1);
  EXPECT_NEAR(change({"default=16"}), 4, 0.6);
  EXPECT_NEAR(change({}), 62.5, 1);
  EXPECT_EQ(lost, 0u);
  EXPECT_LE(c.link->counters().reference_missing, 6u) << "a round trip of each change at most";
}

TEST_F(InterestRoom, IsToldAgainUntilItIsAcknowledgedAndThroughSessions) {
  House& a = add("alice");
  House& c = add("carol");
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  int tries = 0;
  tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    const bool is_interest = wire::parse_opening(bytes)->type == wire::Type::kInterest;
    if (to_server && is_interest) ++tries;
    return !is_interest || tries > 3;
  };
  set(c, {"alice=0"});
  dance.run(Duration::s(2));
  EXPECT_EQ(tries, 4) << "three were lost; acknowledged it is said no more";
  EXPECT_EQ(share_of_alice(c, dance, 1).poses_per_s, 0);
  tunnel.on_datagram = {};
  tunnel.seal_anew(c);
  dance.run(Duration::ms(300));
  EXPECT_EQ(share_of_alice(c, dance, 1).poses_per_s, 0);
  tunnel.stop_server();
  tunnel.start_server();
  dance.run(Duration::s(2));
  ASSERT_TRUE(c.link->is_connected());
  EXPECT_EQ(share_of_alice(c, dance, 1).poses_per_s, 0);
  // Who comes in the same slot is somebody else.
  a.link->send_goodbye();
  dance.run(Duration::ms(100));
  tunnel.link_options.interest = {};
  tunnel.start_link(a, "salsa", {"anna"});
  Dance other{tunnel, {{&a, guest("anna")}}};
  other.run(Duration::s(1));
  EXPECT_GE(c.heard_of(guest("anna")), 50u);
}

// What one who wants all receives per pose, when others want less.
TEST_F(InterestRoom, WhoWantsLessCostsTheOthersLittle) {
  House& a = add("alice");
  House& b = add("bob");
  House& c = add("carol");
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(2));
  const auto bytes_per_s = [&] {
    const auto before = b.link->counters().bytes_in;
    dance.run(Duration::s(4));
    return static_cast<double>(b.link->counters().bytes_in - before) / 4;
  };
  const double alone = bytes_per_s();
  for (const char* want : {"alice=2", "alice=8", "alice=16"}) {
    set(c, {want});
    dance.run(Duration::s(1));
    const double with = bytes_per_s();
    EXPECT_LT(with, 1.35 * alone) << want;
  }
}

TEST(InterestCrowd, WhoWantsHalfGetsFarFewerBytesInNoMoreDatagrams) {
  SimulatedTunnel tunnel;
  std::vector<House*> houses;
  for (int i = 0; i < 16; ++i) {
    tunnel.link_options.interest.others = i == 7 ? 2 : 1;
    houses.push_back(&tunnel.add_house("salsa", {"guest-" + std::to_string(i)}));
  }
  // Each in a millisecond of its own, so that only waiting brings them together.
  const auto dance = [&](Duration duration) {
    tunnel.run(duration, [&] {
      const auto who = static_cast<std::size_t>(tunnel.now().since_zero_us() / 1000 % 16);
      tunnel.dance(*houses[who], guest("guest-" + std::to_string(who)));
    });
  };
  dance(Duration::s(1));
  const LinkCounters all = houses[3]->link->counters(), half = houses[7]->link->counters();
  dance(Duration::s(2));
  const LinkCounters& all_now = houses[3]->link->counters();
  const LinkCounters& half_now = houses[7]->link->counters();
  EXPECT_NEAR(static_cast<double>(half_now.poses_delivered - half.poses_delivered), 15 * 62.5, 20);
  EXPECT_LT(static_cast<double>(half_now.bytes_in - half.bytes_in),
            0.75 * static_cast<double>(all_now.bytes_in - all.bytes_in));
  EXPECT_LE(half_now.datagrams_in - half.datagrams_in, all_now.datagrams_in - all.datagrams_in);
}

TEST_F(InterestRoom, HandsComeAsOftenAsPoses) {
  House& a = add("alice");
  House& b = add("bob");
  House& half = add("carol", {"alice=2"});
  House& none = add("dora", {"alice=0"});
  tunnel.run(Duration::ms(300));
  Hands hands;
  hands.presence = 3;
  hands.clock_id = a.clock_id;
  for (std::uint32_t i = 1; i <= 60; ++i) {
    hands.sequence = i;
    hands.capture_time = tunnel.time_in(a);
    a.link->send(guest("alice"), hands, tunnel.time_in(a));
    tunnel.run(Duration::ms(16));
  }
  tunnel.run(Duration::ms(50));
  EXPECT_EQ(b.hands.size(), 60u);
  EXPECT_EQ(half.hands.size(), 30u);
  EXPECT_EQ(none.hands.size(), 0u);
}

TEST_F(InterestRoom, ADancerWhomAllSeeFromAfarIsSentCoarserUntilSomebodyComesNear) {
  House& alice = add("alice");
  House& bob = add("bob", {"default=4"});
  House& carol = add("carol", {"default=2"});
  const auto quality_m = [&] { return alice.link->local_stats().at(0).quality_m; };
  Dance dance{tunnel, {{&alice, guest("alice")}}};
  dance.run(Duration::s(8));
  EXPECT_DOUBLE_EQ(quality_m(), 0.002);
  set(carol, {"default=1"});
  dance.run(Duration::s(1));
  EXPECT_DOUBLE_EQ(quality_m(), 0.001);
  dance.run(Duration::s(8));
  EXPECT_DOUBLE_EQ(quality_m(), 0.001) << "for the one who is near it stays so";
  set(carol, {"default=0"});
  dance.run(Duration::s(8));
  EXPECT_DOUBLE_EQ(quality_m(), 0.002);
  EXPECT_GT(bob.heard_of(guest("alice")), 100u);
}

TEST_F(InterestRoom, ADancerWhoIsSeenFromNearIsSentInFull) {
  House& alice = add("alice");
  add("bob");
  add("carol");
  Dance dance{tunnel, {{&alice, guest("alice")}}};
  for (int i = 0; i < 20; ++i) {
    dance.run(Duration::ms(500));
    ASSERT_DOUBLE_EQ(alice.link->local_stats().at(0).quality_m, 0.001) << i;
  }
}

}  // namespace
}  // namespace dance
