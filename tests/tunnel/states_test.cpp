// What changes seldom: everybody has the newest of it, whoever comes late too, whatever lines lose,
// and poses do not notice.
#include <gtest/gtest.h>

#include "core/bus/encode.h"
#include "tests/tunnel/simulated_tunnel.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

Avatar avatar_named(std::string_view name) {
  Avatar avatar;
  avatar.name = *AvatarName::parse(name);
  return avatar;
}

Placement placed_at(float x_m) {
  Placement placement;
  placement.x_m = x_m;
  return placement;
}

Scene scene_named(std::string_view name) {
  Scene scene;
  scene.name = *SceneName::parse(name);
  return scene;
}

Style style_of(float hips) {
  Style style;
  style.gain[0] = hips;
  return style;
}

class States : public ::testing::Test {
 protected:
  // Music that began a minute ago in the house's clock.
  Music music(const House& house, std::string_view title) {
    Music music;
    music.time = tunnel.time_in(house);
    music.clock_id = house.clock_id;
    music.start_time = tunnel.time_in(house) - Duration::s(60);
    music.tempo_bpm = 180.0;
    music.playing = true;
    EXPECT_TRUE(music.title.assign(title));
    return music;
  }
  template <class Message>
  void say(House& house, std::string_view who, const Message& message) {
    house.link->send(guest(who), message, tunnel.time_in(house));
  }
  void say_all(House& house, std::string_view who, float n) {
    say(house, who, average_skeleton(1.6f + n * 0.01f));
    say(house, who, avatar_named("fox-" + std::to_string(static_cast<int>(n))));
    say(house, who, style_of(1.0f + n * 0.1f));
    say(house, who, placed_at(n));
  }
  void lose(double share) {
    tunnel.on_datagram = [this, share](bool, PeerId, wire::Bytes) {
      return random.uniform() >= share;
    };
  }

  SimulatedTunnel tunnel;
  Random random{31};
};

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
  a.link->say_goodbye();
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
    house->link->say_goodbye();
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

TEST_F(States, OfTwoWhoSetTheRoomsTheLastOneHoldsAndTheOtherIsTold) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  House& c = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::ms(100));
  const auto expect_holds = [&](std::string_view who, std::string_view scene) {
    for (House* house : {&a, &b, &c}) {
      ASSERT_TRUE(house->scene);
      EXPECT_EQ(house->scene->first, guest(who));
      EXPECT_EQ(house->scene->second.name.view(), scene);
    }
  };
  say(a, "alice", scene_named("mill"));
  tunnel.run(Duration::ms(100));
  expect_holds("alice", "mill");
  say(b, "bob", scene_named("beach"));
  tunnel.run(Duration::ms(100));
  expect_holds("bob", "beach");
  EXPECT_EQ(a.refused, std::vector<std::string>{"scene overruled"});
  // Alice's program says its own again each second, which is no new wish.
  say(a, "alice", scene_named("mill"));
  tunnel.run(Duration::ms(500));
  expect_holds("bob", "beach");
  say(a, "alice", scene_named("forest"));
  tunnel.run(Duration::ms(300));
  expect_holds("alice", "forest");
  EXPECT_EQ(b.refused, std::vector<std::string>{"scene overruled"});
  // Both at once, from the same version on: one of them holds everywhere, the other one is told.
  say(a, "alice", scene_named("moon"));
  say(b, "bob", scene_named("mars"));
  tunnel.run(Duration::ms(600));
  expect_holds("alice", "moon");
  EXPECT_EQ(b.refused.size(), 2u);
  EXPECT_EQ(a.refused.size(), 1u);
  EXPECT_EQ(b.link->counters().states_overruled, 2u);
}

// A player that was overruled goes on playing, and its clock drifts: that is no new wish either.
TEST_F(States, AnOverruledPlayerDoesNotTakeTheRoomBackByDrifting) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  Music hers = music(a, "Son");
  say(a, "alice", hers);
  tunnel.run(Duration::ms(300));
  say(b, "bob", music(b, "Cumbia"));
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(a.refused, std::vector<std::string>{"music overruled"});
  for (int i = 0; i < 30; ++i) {
    hers.start_time += Duration::ms(4);
    say(a, "alice", hers);
    tunnel.run(Duration::s(1));
  }
  EXPECT_EQ(a.music->first, guest("bob"));
  // Another song is.
  say(a, "alice", music(a, "Bolero"));
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(b.music->second.title.view(), "Bolero");
}

TEST_F(States, AWishMadeBeforeTheRoomsIsKnownIsRaisedAboveIt) {
  House& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  for (int i = 0; i < 5; ++i) {
    say(a, "alice", scene_named("mill-" + std::to_string(i)));
    tunnel.run(Duration::ms(300));
  }
  House& b = tunnel.add_house("salsa", {"bob"});
  say(b, "bob", scene_named("beach"));  // there is not even a session yet
  tunnel.run(Duration::s(1));
  ASSERT_TRUE(a.scene);
  EXPECT_EQ(a.scene->second.name.view(), "beach");
  EXPECT_EQ(b.scene->second.name.view(), "beach");
  EXPECT_TRUE(b.refused.empty());
}

TEST_F(States, HostsSetTheRoomsWhereTheyAreThere) {
  House& a = tunnel.add_house("salsa", {"alice"}, {}, {.role = Role::kGuest, .any_name = true});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  say(a, "alice", scene_named("mill"));
  tunnel.run(Duration::ms(100));
  ASSERT_TRUE(b.scene) << "no host is there";
  House& host = tunnel.add_house("salsa", {"dora"}, {}, {.role = Role::kHost, .any_name = true});
  tunnel.run(Duration::ms(200));
  say(a, "alice", scene_named("beach"));
  tunnel.run(Duration::s(1));
  EXPECT_EQ(b.scene->second.name.view(), "mill");
  EXPECT_EQ(a.refused, std::vector<std::string>{"scene not allowed"});
  EXPECT_EQ(a.link->counters().states_refused, 1u);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kNotAllowed), 1u) << "it does not insist";
  say(host, "dora", scene_named("ball"));
  say(a, "alice", avatar_named("fox"));  // her own she may
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(b.scene->second.name.view(), "ball");
  EXPECT_EQ(b.avatars.at(guest("alice")).name.view(), "fox");
}

TEST_F(States, AListenerSetsNothing) {
  House& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(100));
  say(a, "alice", scene_named("mill"));
  say(a, "alice", avatar_named("fox"));
  tunnel.run(Duration::ms(100));
  const auto slot = static_cast<std::uint8_t>(tunnel.server().sessions()[0].slots[0]);
  // A listener's own hello, then datagrams of its own making.
  const PeerId listener = tunnel.add_peer({.role = Role::kListener, .any_name = true});
  wire::Hello hello;
  hello.token = 77;
  hello.room = guest("salsa");
  ASSERT_TRUE(hello.codecs.try_push(tunnel.server().rooms()[0].codec));
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  tunnel.inject(listener, {bytes.data(), wire::build(hello, bytes)});
  ASSERT_EQ(tunnel.server().session_count(), 2u);
  const std::uint64_t before = tunnel.server().counters().states_in;
  MessageBuffer message;
  const std::size_t size = encode(scene_named("mars"), message);
  const auto inject = [&](const wire::State& state) {
    ByteWriter out(bytes);
    wire::begin_states(wire::Type::kState, out);
    wire::add_state(state, out);
    tunnel.inject(listener, out.written());
  };
  const wire::Bytes payload{message.data(), size};
  inject({{wire::StateKind::kScene, 0}, {}, guest("alice"), 1000, payload});
  inject({{wire::StateKind::kScene, 0}, {}, guest("nobody"), 1000, payload});
  for (std::size_t place = 0; place < wire::kGuestStates; ++place)
    inject({wire::guest_state_at(place), {slot, 0}, {}, 1000, payload});
  tunnel.run(Duration::ms(100));
  EXPECT_EQ(tunnel.server().counters().states_in, before);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kNotAllowed), 2u);
  EXPECT_EQ(tunnel.server().counters().of(ServerReject::kForeignSlot), wire::kGuestStates);
  EXPECT_EQ(a.scene->second.name.view(), "mill");
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
    ++told;
  }
  for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
    ByteWriter out(bytes);
    wire::begin_states(wire::Type::kState, out);
    wire::add_state({wire::room_state_at(place), {}, guest("alice"), 5, rubbish}, out);
    tunnel.inject(a.peer, out.written());
    ++told;
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
