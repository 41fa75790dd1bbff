// States: everybody has the newest of each, who comes late too, whatever lines lose,
// and poses do not notice.
#include <gtest/gtest.h>

#include "tests/tunnel/states_scene.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;
using States = StatesScene;

TEST_F(States, ALateJoinerKnowsAllWithinOneRoundTrip) {
  std::vector<House*> houses;
  for (int i = 0; i < 30; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    houses.push_back(&tunnel.add_house("salsa", {name}));
    say_all(*houses.back(), name, static_cast<float>(i));
  }
  tunnel.run(Duration::ms(200));
  say(*houses[3], "guest-3", music(*houses[3], "Guantanamera"));
  say(*houses[4], "guest-4", scene_named("old-mill"));
  tunnel.run(Duration::s(1));
  House& late = tunnel.add_house("salsa", {}, Duration::s(77));
  tunnel.run(Duration::ms(12));  // hello 5 ms, answer 5 ms, and the begin of the next step
  EXPECT_EQ(late.skeletons.size(), 30u);
  ASSERT_EQ(late.avatars.size(), 30u);
  ASSERT_EQ(late.styles.size(), 30u);
  ASSERT_EQ(late.placements.size(), 30u);
  EXPECT_EQ(late.avatars.at(guest("guest-7")).name.view(), "fox-7");
  EXPECT_FLOAT_EQ(late.styles.at(guest("guest-7")).gain[0], 1.7f);
  EXPECT_EQ(late.placements.at(guest("guest-29")).x_m, 29.0f);
  ASSERT_TRUE(late.music && late.scene);
  EXPECT_EQ(late.music->first, guest("guest-3"));
  EXPECT_EQ(late.music->second.title.view(), "Guantanamera");
  EXPECT_EQ(late.scene->second.name.view(), "old-mill");
}

TEST_F(States, EverybodyStandsAtTheSameBeatWhateverTheirClocksSay) {
  House& a = tunnel.add_house("salsa", {"alice"}, Duration::s(-1000));
  House& b = tunnel.add_house("salsa", {"bob"}, Duration::s(5000));
  tunnel.run(Duration::s(1));
  const Music played = music(a, "Lagrimas Negras");
  say(a, "alice", played);
  tunnel.run(Duration::ms(100));
  for (House* house : {&a, &b}) {
    ASSERT_TRUE(house->music);
    EXPECT_EQ(house->music->second.clock_id, house->clock_id);
    EXPECT_NEAR(house->music->second.beats_at(tunnel.time_in(*house)),
                played.beats_at(tunnel.time_in(a)), 0.01);
  }
  EXPECT_EQ(a.music->first, guest("alice")) << "who set it hears that it holds";
  // Said again each second: nothing new.
  const std::uint64_t before = a.link->counters().states_sent;
  for (int i = 0; i < 20; ++i) {
    tunnel.run(Duration::s(1));
    Music again = played;
    again.time = tunnel.time_in(a);
    say(a, "alice", again);
  }
  EXPECT_EQ(a.link->counters().states_sent, before);
  const auto mapped = b.link->room_music(tunnel.time_in(b));
  ASSERT_TRUE(mapped);
  EXPECT_NEAR(mapped->beats_at(tunnel.time_in(b)), played.beats_at(tunnel.time_in(a)), 0.01);
}

TEST_F(States, MusicOfAnUnknownClockCountsFromWhenItWasSaid) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  Music foreign = music(a, "Son");
  foreign.clock_id = 4711;
  foreign.time = MonoTime::from_us(3'000'000);
  foreign.start_time = foreign.time - Duration::s(10);  // 30 beats ago
  say(a, "alice", foreign);
  const MonoTime said = tunnel.now();
  tunnel.run(Duration::ms(50));
  ASSERT_TRUE(b.music);
  EXPECT_NEAR(b.music->second.beats_at(said), 30.0, 0.05);
}

TEST_F(States, ThirtyPercentLossConvergesOnTheNewest) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  House& c = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(100));
  lose(0.3);
  for (int i = 1; i <= 100; ++i) {
    say(a, "alice", placed_at(static_cast<float>(i) * 0.5f));
    say(a, "alice", style_of(static_cast<float>(i) * 0.01f));
    if (i % 20 == 0) say(b, "bob", scene_named("scene-" + std::to_string(i)));
    tunnel.run(Duration::ms(30));
  }
  tunnel.run(Duration::s(6));
  for (House* house : {&b, &c}) {
    EXPECT_EQ(house->placements.at(guest("alice")).x_m, 50.0f);
    EXPECT_FLOAT_EQ(house->styles.at(guest("alice")).gain[0], 1.0f);
  }
  for (House* house : {&a, &b, &c}) {
    ASSERT_TRUE(house->scene);
    EXPECT_EQ(house->scene->second.name.view(), "scene-100");
  }
  const std::uint64_t sent = a.link->counters().states_sent;
  const std::uint64_t told = tunnel.server().counters().states_out;
  tunnel.run(Duration::s(2));
  EXPECT_EQ(a.link->counters().states_sent, sent) << "acknowledged, nothing is repeated";
  EXPECT_EQ(tunnel.server().counters().states_out, told);
}

// The same dance, with and without a flood of states beside it, pose for pose and time for time.
TEST(StatesFlood, DelaysNoPose) {
  const auto dance_beside = [](bool is_flooded) {
    SimulatedTunnel tunnel;
    House& a = tunnel.add_house("salsa", {"alice"});
    House& b = tunnel.add_house("salsa", {"bob"});
    tunnel.run(Duration::ms(500));
    float n = 0.0f;
    tunnel.run(Duration::s(3), [&] {
      const std::int64_t ms = tunnel.now().since_zero_us() / 1000;
      if (is_flooded) {
        Style style;
        style.periodic = 1.0f + (n += 1e-4f);
        b.link->send(guest("bob"), style, tunnel.time_in(b));
        a.link->send(guest("alice"), style, tunnel.time_in(a));
      }
      if (ms % 16 == 0) tunnel.dance(a, guest("alice"));
    });
    std::vector<std::pair<std::uint32_t, MonoTime>> heard;
    for (const auto& pose : b.poses) heard.emplace_back(pose.pose.sequence, pose.at);
    tunnel.run(Duration::s(1));
    if (is_flooded) {
      EXPECT_FLOAT_EQ(b.styles.at(guest("alice")).periodic, 1.0f + n);
      EXPECT_GT(tunnel.server().counters().states_in, 10u);
    }
    return heard;
  };
  const auto quiet = dance_beside(false);
  EXPECT_GT(quiet.size(), 180u);
  EXPECT_EQ(dance_beside(true), quiet);
}

TEST_F(States, AGuestsGoWithTheGuestAndTheRoomsStay) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  say(a, "alice", avatar_named("fox"));
  say(a, "alice", scene_named("mill"));
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(b.avatars.size(), 1u);
  a.link->send_goodbye();
  a.is_running = false;
  tunnel.run(Duration::ms(100));
  House& c = tunnel.add_house("salsa", {"alice"});  // another one of this name
  House& d = tunnel.add_house("salsa", {"dora"});
  tunnel.run(Duration::ms(300));
  EXPECT_TRUE(d.avatars.empty());
  ASSERT_TRUE(c.scene && d.scene);
  EXPECT_EQ(d.scene->second.name.view(), "mill");
  EXPECT_EQ(d.scene->first, guest("alice"));
  // The last one closes the room: nothing is left of it.
  for (House* house : {&b, &c, &d}) {
    house->link->send_goodbye();
    house->is_running = false;
  }
  tunnel.run(Duration::ms(100));
  House& e = tunnel.add_house("salsa", {"emma"});
  tunnel.run(Duration::ms(300));
  EXPECT_FALSE(e.scene);
}

TEST_F(States, ComeBackWhenTheServerBeginsAnew) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  say_all(a, "alice", 5.0f);
  const Music played = music(a, "Chan Chan");
  say(a, "alice", played);
  say(b, "bob", scene_named("mill"));
  tunnel.run(Duration::ms(300));
  tunnel.stop_server();
  tunnel.run(Duration::s(2));
  tunnel.start_server();
  tunnel.run(Duration::s(3));
  House& c = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(c.avatars.at(guest("alice")).name.view(), "fox-5");
  ASSERT_TRUE(c.music && c.scene);
  EXPECT_EQ(c.music->first, guest("alice"));
  EXPECT_NEAR(c.music->second.beats_at(tunnel.time_in(c)), played.beats_at(tunnel.time_in(a)),
              0.05);
  EXPECT_EQ(c.scene->first, guest("bob"));
  EXPECT_TRUE(a.refused.empty() && b.refused.empty());
}

TEST_F(States, ChangesAboveTheLimitWaitAndTheNewestComes) {
  ServerLimits limits;
  limits.state_changes_per_second = 5.0;
  limits.state_change_burst = 2.0;
  SimulatedTunnel slow(limits);
  House& a = slow.add_house("salsa", {"alice"});
  House& b = slow.add_house("salsa", {"bob"});
  slow.run(Duration::ms(100));
  for (int i = 1; i <= 200; ++i) {
    a.link->send(guest("alice"), placed_at(static_cast<float>(i) * 0.1f), slow.time_in(a));
    slow.run(Duration::ms(10));
  }
  EXPECT_GT(slow.server().counters().of(ServerReject::kStateRate), 0u);
  EXPECT_LE(slow.server().counters().states_in, 14u);
  slow.run(Duration::s(1));
  EXPECT_FLOAT_EQ(b.placements.at(guest("alice")).x_m, 20.0f);
}

TEST_F(States, DamagedPayloadsAreCountedAndGoNoFurther) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  const auto slot = tunnel.server().sessions()[0].slots[0];
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  const std::vector<std::uint8_t> rubbish(60, 0xee);
  std::uint64_t told = 0;
  for (std::size_t place = 0; place < wire::kGuestStates; ++place) {
    ByteWriter out(bytes);
    wire::begin_states(wire::Type::kState, out);
    wire::add_state({wire::guest_state_at(place), {slot, 0}, {}, 5, rubbish}, out);
    tunnel.inject(a.peer, out.written());
    // The server reads chat, and refuses a damaged one.
    told += wire::guest_state_at(place).kind == wire::StateKind::kChat ? 0 : 1;
  }
  for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
    ByteWriter out(bytes);
    wire::begin_states(wire::Type::kState, out);
    const wire::StateName name = wire::room_state_at(place);
    wire::add_state({name, {}, guest("alice"), 5, rubbish}, out);
    tunnel.inject(a.peer, out.written());
    // The server reads a song's lock, and refuses a damaged one.
    told += name.kind == wire::StateKind::kSong ? 0 : 1;
  }
  tunnel.run(Duration::s(1));
  const LinkCounters& c = b.link->counters();
  EXPECT_EQ(c.states_invalid + c.channels_invalid, told);
  EXPECT_EQ(c.states_delivered, 0u);
  EXPECT_FALSE(b.music || b.scene || !b.avatars.empty());
  EXPECT_TRUE(b.link->is_connected());
  // Acknowledged all the same: nobody says it for ever.
  const std::uint64_t out = tunnel.server().counters().states_out;
  tunnel.run(Duration::s(1));
  EXPECT_EQ(tunnel.server().counters().states_out, out);
}

}  // namespace
}  // namespace dance
