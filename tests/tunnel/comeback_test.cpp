// Links and a server with a simulated line between them: what was interrupted goes on.
#include <gtest/gtest.h>

#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

TEST(Comeback, AfterAServerRestartEverybodyIsBackWithinThreeSeconds) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(1));
  a.link->send(guest("alice"), average_skeleton(1.6f), tunnel.time_in(a));
  dance.run(Duration::ms(200));
  ASSERT_EQ(b.skeletons.size(), 1u);
  tunnel.stop_server();
  dance.run(Duration::s(2));
  EXPECT_EQ(a.link->state(), LinkState::kLapsed);
  tunnel.start_server();
  dance.run(Duration::s(3));
  EXPECT_TRUE(a.link->is_connected());
  EXPECT_TRUE(b.link->is_connected());
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
  EXPECT_EQ(b.skeletons.size(), 2u) << "a new server learns the skeleton from the link again";
  EXPECT_EQ(a.link->counters().reconnects, 1u);
}

TEST(Comeback, ARestartThatNobodyHadTimeToNoticeIsOverWithTheNextSealedSession) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  tunnel.stop_server();
  tunnel.start_server();
  dance.run(Duration::ms(60));
  EXPECT_TRUE(a.link->is_connected());
  EXPECT_EQ(tunnel.server().session_count(), 1u);
  EXPECT_EQ(a.link->counters().lapses, 1u);
}

TEST(Comeback, ALinkThatComesBackThroughAnotherSealedSessionTakesItsPlaceAtOnce) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(1));
  tunnel.seal_anew(a);
  dance.run(Duration::ms(100));
  EXPECT_TRUE(a.link->is_connected());
  EXPECT_EQ(tunnel.server().counters().sessions_resumed, 1u);
  EXPECT_EQ(tunnel.server().session_count(), 2u);
  EXPECT_FALSE(b.saw("-alice"));
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
  EXPECT_GE(a.heard_of(guest("bob")), before);
}

TEST(Comeback, ALinkSaysNothingUntilItIsSealedAndNothingAfterItIsNot) {
  SimulatedTunnel tunnel;
  tunnel.stop_server();
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::s(3), [&] { a.link->tick(tunnel.time_in(a)); });
  EXPECT_EQ(a.link->counters().datagrams_out, 0u);
  EXPECT_FALSE(a.link->next_deadline().is_set());
  tunnel.start_server();
  tunnel.run(Duration::ms(12));
  EXPECT_TRUE(a.link->is_connected()) << "hello at once";
  a.link->on_unsealed(tunnel.time_in(a));
  EXPECT_EQ(a.link->state(), LinkState::kLapsed);
  const auto hellos = a.link->counters().hellos;
  const auto sent = a.link->counters().datagrams_out;
  tunnel.run(Duration::s(1), [&] { tunnel.dance(a, guest("alice")); });
  EXPECT_EQ(a.link->counters().hellos, hellos);
  EXPECT_EQ(a.link->counters().datagrams_out, sent);
  tunnel.seal_anew(a);
  tunnel.run(Duration::ms(12));
  EXPECT_TRUE(a.link->is_connected());
}

TEST(Comeback, WhatComesBeforeTheWelcomeOfASealedSessionIsNoSignOfTheServer) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  std::vector<std::uint8_t> pong;
  tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    if (!to_server && wire::parse_opening(bytes)->type == wire::Type::kPong)
      pong.assign(bytes.begin(), bytes.end());
    return true;
  };
  tunnel.run(Duration::ms(500));
  ASSERT_FALSE(pong.empty());
  tunnel.on_datagram = {};
  a.link->on_sealed(tunnel.time_in(a));
  EXPECT_EQ(a.link->state(), LinkState::kLapsed);
  const auto rejected = a.link->counters().rejected_datagrams;
  a.link->receive(pong, tunnel.time_in(a), tunnel.time_in(a));
  EXPECT_EQ(a.link->state(), LinkState::kLapsed);
  EXPECT_EQ(a.link->counters().rejected_datagrams, rejected + 1);
  tunnel.run(Duration::ms(12));
  EXPECT_TRUE(a.link->is_connected());
}

TEST(Comeback, AShortLapseChangesNothingForTheOthers) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(1));
  a.is_cut = true;
  dance.run(Duration::ms(1200));
  EXPECT_TRUE(a.saw("lapsed"));
  a.is_cut = false;
  dance.run(Duration::ms(600));
  EXPECT_TRUE(a.link->is_connected());
  EXPECT_FALSE(b.saw("-alice"));
  EXPECT_GT(b.link->remote_stats().at(0).lost, 40u) << "what was danced meanwhile is missing";
}

TEST(Comeback, WhoHearsNothingStillDancesForTheOthers) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(2));
  const PeerId deaf = a.peer;
  tunnel.on_datagram = [deaf](bool to_server, PeerId peer, wire::Bytes) {
    return to_server || peer != deaf;
  };
  dance.run(Duration::ms(1500));
  EXPECT_EQ(a.link->state(), LinkState::kLapsed);
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(1));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
  EXPECT_EQ(b.link->counters().reference_missing, 0u);
}

TEST(Comeback, WhatFirstComesThroughALineThatWasCutIsAPose) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(30));
  a.is_cut = true;
  dance.run(Duration::ms(1500));
  ASSERT_EQ(a.link->state(), LinkState::kLapsed);
  a.is_cut = false;
  const auto before = b.heard_of(guest("alice"));
  // A frame, and 10 ms of way.
  dance.run(Duration::ms(Dance::kFrame_ms + 10 + 1));
  EXPECT_GT(b.heard_of(guest("alice")), before);
}

// What is still under way from the old session looks as if it stood, until its successor's welcome
// comes.
TEST(Comeback, TheOldSessionsLastDatagramsDoNotHideTheNewOne) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  dance.run(Duration::s(30));
  std::vector<std::uint8_t> last;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    if (!to_server && peer == a.peer) last.assign(bytes.begin(), bytes.end());
    return true;
  };
  dance.run(Duration::ms(100));
  const PeerId cut = a.peer;
  bool is_over = false;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes) {
    // The way up comes back first.
    return peer != cut || (to_server && is_over);
  };
  dance.run(Duration::ms(2500));
  is_over = true;
  dance.run(Duration::ms(300));
  ASSERT_EQ(tunnel.server().session_count(), 2u) << "the hello has come";
  tunnel.on_datagram = {};
  a.link->receive(last, tunnel.time_in(a), tunnel.time_in(a));
  ASSERT_TRUE(a.link->is_connected());
  const auto before = b.heard_of(guest("alice"));
  dance.run(Duration::s(2));
  EXPECT_GE(b.heard_of(guest("alice")), before + 60);
}

// Until its welcome comes, a link dances on in the session before, where its guests had other
// slots.
TEST(Comeback, NobodyDancesAsSomebodyElseOfTheHouse) {
  SimulatedTunnel tunnel;
  ASSERT_TRUE(tunnel.link_options.codecs.try_push({CodecId::kPlain, 0}));
  auto& carol = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(200));
  auto& a = tunnel.add_house("salsa", {"alice", "bob"});
  auto& watcher = tunnel.add_house("salsa", {"dora"});
  tunnel.run(Duration::ms(200));
  std::uint32_t number = 0;
  const auto dance = [&](Duration span) {
    tunnel.run(span, [&] {
      if (tunnel.now().since_zero_us() / 1000 % 16 != 0) return;
      const MonoTime now = tunnel.time_in(a);
      ++number;
      a.link->send(guest("alice"), pose_number(100'000 + number, now, a.clock_id), now);
      a.link->send(guest("bob"), pose_number(number, now, a.clock_id), now);
    });
  };
  dance(Duration::s(1));
  carol.link->send_goodbye();
  carol.is_running = false;
  dance(Duration::s(1));
  for (int i = 0; i < 8; ++i) {
    a.is_cut = true;
    dance(Duration::ms(2300 + 30 * i));
    a.is_cut = false;
    dance(Duration::s(2));
  }
  std::size_t bobs = 0;
  for (const auto& heard : watcher.poses) {
    const bool is_bob = heard.guest == guest("bob");
    ASSERT_EQ(heard.pose.sequence < 100'000u, is_bob);
    bobs += is_bob ? 1 : 0;
  }
  EXPECT_GT(bobs, 700u);
}

TEST(Comeback, AfterACutThatEndedTheSessionTheDanceIsBackSoonWheneverTheWayIs) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  for (int cut_ms = 3000; cut_ms < 4000; cut_ms += 130) {
    dance.run(Duration::s(2));
    a.is_cut = true;
    dance.run(Duration::ms(cut_ms));
    ASSERT_EQ(tunnel.server().session_count(), 1u);
    a.is_cut = false;
    const auto at_a = a.heard_of(guest("bob")), at_b = b.heard_of(guest("alice"));
    // Until it asks again, and four round trips of 20 ms: asking, roster and proportions, a key
    // frame.
    dance.run(Duration::ms(250 + 4 * 20));
    EXPECT_GT(a.heard_of(guest("bob")), at_a) << cut_ms;
    EXPECT_GT(b.heard_of(guest("alice")), at_b) << cut_ms;
  }
}

TEST(Comeback, WhoHearsNothingForLongAsksOnceASecondAndSoonTriesAnotherSocket) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::s(1));
  a.is_cut = true;
  const auto before = a.link->counters().hellos;
  tunnel.run(Duration::s(11));
  EXPECT_LE(a.link->counters().hellos, before + 45);
  EXPECT_GE(a.link->unanswered_hellos(), 9) << "one a second counts";
  EXPECT_LE(a.link->unanswered_hellos(), 14);
  const auto later = a.link->counters().hellos;
  tunnel.run(Duration::s(60));
  EXPECT_LE(a.link->counters().hellos, later + 61);
  a.is_cut = false;
  tunnel.run(Duration::ms(1100));
  EXPECT_TRUE(a.link->is_connected());
}

}  // namespace
}  // namespace dance
