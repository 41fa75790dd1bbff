// Links and a server with a simulated line between them: sessions come, survive and end.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

TEST(Session, TwoHousesHearEachOtherAndNeverThemselves) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  ASSERT_TRUE(a.link->is_connected());
  ASSERT_TRUE(b.link->is_connected());
  EXPECT_EQ(a.events, (std::vector<std::string>{"connected", "+bob"}));
  Dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}}.run(Duration::s(2));
  tunnel.run(Duration::ms(50));
  EXPECT_GE(a.heard_of(guest("bob")), 120u);
  EXPECT_EQ(a.heard_of(guest("bob")), b.link->counters().poses_sent);
  EXPECT_EQ(b.heard_of(guest("alice")), a.link->counters().poses_sent);
  EXPECT_EQ(a.heard_of(guest("alice")), 0u);
  EXPECT_EQ(b.heard_of(guest("bob")), 0u);
  EXPECT_EQ(a.link->remote_stats().at(0).lost, 0u);
}

TEST(Session, RoomsDoNotHearEachOther) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("tango", {"alice"});  // the same name is free in another room
  Dance{tunnel, {{&a, guest("alice")}, {&b, guest("alice")}}}.run(Duration::s(1));
  EXPECT_TRUE(b.link->is_connected());
  EXPECT_TRUE(a.poses.empty());
  EXPECT_TRUE(b.poses.empty());
  EXPECT_EQ(tunnel.server().room_count(), 2u);
}

TEST(Session, TimesArriveInTheReceiversClock) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"}, Duration::s(-1234));
  auto& b = tunnel.add_house("salsa", {"bob"}, Duration::s(98'765));
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  tunnel.run(Duration::ms(50));
  ASSERT_FALSE(b.poses.empty());
  // Not every pose brings the stamps of its way.
  const auto& heard = *std::find_if(b.poses.rbegin(), b.poses.rend(), [](const auto& one) {
    return one.pose.stamped(Hop::kServer).is_set();
  });
  // 10 ms old when sent, 5 ms up, 5 ms down; lines are symmetric, so the mapping is exact but for
  // rounding to microseconds.
  const auto near_ms = [](Duration d, double ms) { return std::abs(d.as_ms() - ms) < 0.01; };
  EXPECT_TRUE(near_ms(heard.at - heard.pose.capture_time, 20.0));
  EXPECT_EQ(heard.pose.clock_id, b.clock_id);
  const MonoTime capture = heard.pose.capture_time;
  EXPECT_TRUE(near_ms(heard.pose.stamped(Hop::kPublished) - capture, 2.0));
  EXPECT_TRUE(near_ms(heard.pose.stamped(Hop::kLinkSent) - capture, 10.0));
  EXPECT_TRUE(near_ms(heard.pose.stamped(Hop::kServer) - capture, 15.0));
  EXPECT_TRUE(near_ms(heard.pose.stamped(Hop::kLinkReceived) - capture, 20.0));
  EXPECT_FALSE(heard.pose.stamped(Hop::kStaged).is_set());
}

TEST(Session, PosesOfAnotherClockAreStampedAnewAndCounted) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {});
  tunnel.run(Duration::ms(200));
  a.link->send(guest("alice"), pose_number(1, MonoTime::from_us(77), 4242), tunnel.time_in(a));
  tunnel.run(Duration::ms(20));
  ASSERT_EQ(b.poses.size(), 1u);
  EXPECT_NEAR((b.poses[0].at - b.poses[0].pose.capture_time).as_ms(), 10.0, 0.1);
  EXPECT_EQ(a.link->counters().foreign_clock, 1u);
}

TEST(Session, PosesBeforeTheSessionAreDroppedAndCounted) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.dance(a, guest("alice"));
  EXPECT_EQ(a.link->counters().unrouted, 1u);
  EXPECT_EQ(a.link->counters().datagrams_out, 0u);
}

TEST(Session, ALateJoinerGetsRosterAndSkeletonsWithinARoundTripOfItsWelcome) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  Skeleton skeleton = average_skeleton(1.63f);
  skeleton.version = 7;
  a.link->send(guest("alice"), skeleton, tunnel.time_in(a));
  tunnel.run(Duration::s(1));
  auto& late = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(1 + 10 + 10 + 2));  // hello and welcome, ping and answer
  ASSERT_EQ(late.skeletons.size(), 1u);
  EXPECT_TRUE(late.saw("+alice"));
  EXPECT_EQ(late.skeletons[0].first, guest("alice"));
  EXPECT_EQ(late.skeletons[0].second.version, 7u);
  EXPECT_NEAR(standing_height_m(late.skeletons[0].second), standing_height_m(skeleton), 0.002f);
  tunnel.run(Duration::s(2));
  EXPECT_EQ(late.skeletons.size(), 1u) << "said once, however often it was repeated";
}

TEST(Session, AChangedSkeletonArrivesThoughTheFirstTriesAreLost) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  int states = 0;
  tunnel.on_datagram = [&](bool, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    return opening->type != wire::Type::kState || ++states > 4;
  };
  for (int i = 0; i < 3; ++i) {
    a.link->send(guest("alice"), average_skeleton(1.80f), tunnel.time_in(a));
    tunnel.run(Duration::s(1));
  }
  ASSERT_EQ(b.skeletons.size(), 1u);
  const int repeated = states;
  tunnel.run(Duration::s(2));
  EXPECT_EQ(states, repeated) << "acknowledged, it is not sent again";
}

TEST(Session, HandsArriveBesideThePose) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  Hands hands;
  hands.presence = 0x3fffffff;
  hands.sequence = 5;
  hands.clock_id = a.clock_id;
  hands.capture_time = tunnel.time_in(a);
  a.link->send(guest("alice"), hands, tunnel.time_in(a));
  tunnel.run(Duration::ms(20));
  ASSERT_EQ(b.hands.size(), 1u);
  EXPECT_EQ(b.hands[0].second.sequence, 5u);
  EXPECT_EQ(b.hands[0].second.presence, hands.presence);
}

TEST(Session, ASilentHouseIsGoneWithinTwoSecondsAndItsNameIsFree) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(300));
  a.is_running = false;  // killed: no goodbye
  tunnel.run(Duration::ms(1500));
  EXPECT_FALSE(b.saw("-alice"));
  tunnel.run(Duration::ms(800));
  EXPECT_TRUE(b.saw("-alice"));
  EXPECT_EQ(tunnel.server().guest_count(), 1u);
  auto& other = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(other.link->is_connected());
}

TEST(Session, AGoodbyeIsHeardAtOnce) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(300));
  a.link->send_goodbye();
  a.is_running = false;
  tunnel.run(Duration::ms(12));
  EXPECT_TRUE(b.saw("-alice"));
}

TEST(Session, TheCountsOfOneWhoLeftAreKeptForTheSummary) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  tunnel.run(Duration::ms(50));
  a.link->send_goodbye();
  tunnel.run(Duration::ms(50));
  const auto stats = b.link->remote_stats();
  ASSERT_EQ(stats.size(), 1u);
  EXPECT_FALSE(stats[0].is_here);
  EXPECT_EQ(stats[0].received, b.heard_of(guest("alice")));
}

TEST(Session, ALinkStartedAgainTakesItsNameBackWithinThreeSeconds) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(1));
  tunnel.start_link(a, "salsa", {"alice"});
  a.next_sequence = 1;
  dance.run(Duration::s(3));
  EXPECT_TRUE(a.link->is_connected());
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
}

TEST(Session, AProducerStartedAgainGoesOnAtOnceAndItsOldPosesDoNot) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  const Pose old =
      pose_number(a.next_sequence + 1, tunnel.time_in(a) - Duration::ms(500), a.clock_id);
  a.next_sequence = 1;
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
  EXPECT_EQ(a.link->counters().stream_restarts, 1u);
  a.link->send(guest("alice"), old, tunnel.time_in(a));
  EXPECT_EQ(a.link->counters().late, 1u);
  EXPECT_EQ(b.link->remote_stats().at(0).lost, 0u) << "a restart is no loss";
}

TEST(Session, SequencesWrapWithoutALoss) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(200));
  a.next_sequence = UINT32_MAX - 30;
  Dance{tunnel, {{&a, guest("alice")}}}.run(Duration::s(1));
  tunnel.run(Duration::ms(50));
  EXPECT_LT(a.next_sequence, 100u);
  EXPECT_EQ(b.heard_of(guest("alice")), a.link->counters().poses_sent);
  EXPECT_EQ(b.link->remote_stats().at(0).lost, 0u);
}

TEST(Session, ThirtyHousesOfOneGuestAllHearEachOther) {
  SimulatedTunnel tunnel;
  Dance dance{tunnel, {}};
  std::vector<SimulatedTunnel::House*> houses;
  for (int i = 0; i < 30; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    houses.push_back(&tunnel.add_house("salsa", {name}));
    dance.dancers.emplace_back(houses.back(), guest(name));
  }
  dance.run(Duration::ms(500));
  const auto before = houses[0]->poses.size();
  dance.run(Duration::ms(160));
  EXPECT_EQ(houses[0]->poses.size() - before, 290u);
  // What came in one turn left in shared datagrams: far fewer than records.
  const ServerCounters& c = tunnel.server().counters();
  EXPECT_LT(c.datagrams_out * 2, c.records_out);
  EXPECT_EQ(houses[7]->link->remote_stats().size(), 29u);
}

TEST(Session, AFullRoomAndAFullServerSaySo) {
  ServerLimits limits;
  limits.guests_per_room = 2;
  limits.sessions = 3;
  limits.rooms = 2;
  SimulatedTunnel tunnel(limits);
  tunnel.add_house("salsa", {"alice", "bob"});
  auto& third = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(third.saw("refused 4 "));
  tunnel.add_house("tango", {});
  auto& room = tunnel.add_house("bachata", {});
  tunnel.run(Duration::ms(100));
  EXPECT_TRUE(room.saw("refused 5 "));
}

}  // namespace
}  // namespace dance
