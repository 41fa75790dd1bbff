// The room's music, song and scene: who may set them, and whose is in force.
#include "tests/tunnel/states_scene.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;
using RoomStates = StatesScene;

TEST_F(RoomStates, OfTwoWhoSetTheRoomsTheLastOneHoldsAndTheOtherIsTold) {
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
  // Alice's program says its own again each second, which is no new request.
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

// A player that was overruled goes on playing, and its clock drifts: that is no new request either.
TEST_F(RoomStates, AnOverruledPlayerDoesNotTakeTheRoomBackByDrifting) {
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

// Two players of one house, each of whom says its own again and again.
TEST_F(RoomStates, TwoGuestsOfOneHouseDoNotTakeTurns) {
  House& a = tunnel.add_house("salsa", {"anna", "alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::ms(100));
  const Music annas = music(a, "Son"), alices = music(a, "Bolero");
  const std::uint64_t before = tunnel.server().counters().states_in;
  for (int i = 0; i < 10; ++i) {
    say(a, "anna", annas);
    say(a, "anna", scene_named("mill"));
    tunnel.run(Duration::ms(500));
    say(a, "alice", alices);
    say(a, "alice", scene_named("beach"));
    tunnel.run(Duration::ms(500));
  }
  EXPECT_EQ(tunnel.server().counters().states_in - before, 4u);
  ASSERT_TRUE(b.music && b.scene);
  EXPECT_EQ(b.music->first, guest("alice"));
  EXPECT_EQ(b.scene->first, guest("alice"));
}

TEST_F(RoomStates, AWishMadeBeforeTheRoomsIsKnownIsRaisedAboveIt) {
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

TEST_F(RoomStates, HostsSetTheRoomsWhereTheyAreThere) {
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

TEST_F(RoomStates, MapsTheStartOfASongToTheSameMomentInEveryHouse) {
  House& a = tunnel.add_house("salsa", {"alice"});
  House& b = tunnel.add_house("salsa", {"bob"});
  tunnel.run(Duration::s(2));
  const RoomSong hers = song(a, 7);
  const Duration begun = tunnel.time_in(a) - hers.start_time;
  const MonoTime published = tunnel.now();
  say(a, "alice", hers);
  tunnel.run(Duration::s(1));
  House& c = tunnel.add_house("salsa", {"carol"});
  tunnel.run(Duration::s(2));
  for (House* house : {&b, &c}) {
    const auto mapped = house->link->room_song(tunnel.time_in(*house));
    ASSERT_TRUE(mapped);
    EXPECT_EQ(mapped->seed, 7u);
    const Duration age = tunnel.time_in(*house) - mapped->start_time;
    EXPECT_NEAR(age.as_ms(), (begun + (tunnel.now() - published)).as_ms(), 3.0);
  }
}

TEST_F(RoomStates, AnyGuestSetsTheSongUntilAHostLocksIt) {
  House& a = tunnel.add_house("salsa", {"alice"}, {}, {.role = Role::kGuest, .any_name = true});
  House& host = tunnel.add_house("salsa", {"dora"}, {}, {.role = Role::kHost, .any_name = true});
  tunnel.run(Duration::ms(200));
  say(a, "alice", song(a, 1));
  tunnel.run(Duration::ms(300));
  ASSERT_TRUE(host.song);
  EXPECT_EQ(host.song->second.seed, 1u);
  RoomSong locked = song(host, 2);
  locked.locked = true;
  say(host, "dora", locked);
  tunnel.run(Duration::ms(300));
  say(a, "alice", song(a, 3));
  tunnel.run(Duration::s(1));
  EXPECT_EQ(host.song->second.seed, 2u);
  EXPECT_EQ(a.refused, (std::vector<std::string>{"song overruled", "song not allowed"}));
  say(host, "dora", song(host, 4));
  tunnel.run(Duration::ms(300));
  say(a, "alice", song(a, 5));
  tunnel.run(Duration::ms(300));
  EXPECT_EQ(host.song->second.seed, 5u);
}

TEST_F(RoomStates, IgnoresTheLockOfAHostWhoHasLeft) {
  House& a = tunnel.add_house("salsa", {"alice"}, {}, {.role = Role::kGuest, .any_name = true});
  {
    House& host = tunnel.add_house("salsa", {"dora"}, {}, {.role = Role::kHost, .any_name = true});
    tunnel.run(Duration::ms(200));
    RoomSong locked = song(host, 2);
    locked.locked = true;
    say(host, "dora", locked);
    tunnel.run(Duration::ms(300));
    host.link->send_goodbye();
  }
  tunnel.run(Duration::ms(300));
  ASSERT_TRUE(a.song);
  ASSERT_TRUE(a.song->second.locked);
  RoomSong next = song(a, 3);
  next.locked = true;
  say(a, "alice", next);
  tunnel.run(Duration::s(1));
  EXPECT_EQ(a.song->second.seed, 3u);
  EXPECT_TRUE(a.refused.empty());
}

TEST_F(RoomStates, AListenerSetsNothing) {
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

}  // namespace
}  // namespace dance
