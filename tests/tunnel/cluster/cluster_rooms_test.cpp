// A room whose guests come through several servers is one room.
#include <gtest/gtest.h>

#include <set>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tests/tunnel/referring_codec.h"
#include "tests/tunnel/states_scene.h"
#include "tunnel/wire/wire_room.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

TEST(ClusterRooms, GuestsOfAllServersDanceTogether) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  House& c = cluster[2].add("carla");
  House& elsewhere = cluster[1].add("dora", "tango");
  cluster.run(Duration::ms(300));
  cluster.dance(Duration::s(2), {{&a, "alice"}, {&b, "bob"}, {&c, "carla"}});
  cluster.run(Duration::ms(100));
  for (const House* house : {&a, &b, &c})
    for (const char* name : {"alice", "bob", "carla"}) {
      if (house->heard_of(guest(name)) == 0) continue;
      EXPECT_GE(house->heard_of(guest(name)), 123u) << name;
      EXPECT_TRUE(house->saw("+" + std::string(name)));
    }
  EXPECT_EQ(a.heard_of(guest("alice")), 0u);
  EXPECT_GT(a.heard_of(guest("bob")), 0u);
  EXPECT_GT(a.heard_of(guest("carla")), 0u);
  EXPECT_GT(b.heard_of(guest("alice")), 0u);
  EXPECT_GT(c.heard_of(guest("bob")), 0u);
  EXPECT_TRUE(elsewhere.poses.empty());
  EXPECT_FALSE(elsewhere.saw("+alice"));
  // The last pose came as it was, with its time in the receiver's own clock.
  EXPECT_EQ(b.poses.back().pose.sequence, std::max(a.next_sequence, c.next_sequence) - 1);
}

TEST(ClusterRooms, APoseIsPublishedOnceHoweverManyServersWantIt) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& alone = cluster[0].add("zoe", "waltz");
  cluster.run(Duration::ms(300));
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&alone, "zoe"}});
  EXPECT_EQ(cluster[0].published["dance.1.pose"], 0) << "nobody elsewhere is in these rooms";
  cluster[1].add("bob");
  cluster[1].add("bert");
  cluster[2].add("carla");
  cluster.run(Duration::ms(300));
  const std::uint32_t before = a.next_sequence;
  cluster[0].published.clear();
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&alone, "zoe"}});
  cluster.run(Duration::ms(100));
  EXPECT_EQ(cluster[0].published["dance.1.pose"], static_cast<int>(a.next_sequence - before));
  EXPECT_TRUE(cluster[1].listens_to("dance.1.pose.salsa.alice"));
  EXPECT_FALSE(cluster[1].listens_to("dance.1.pose.waltz.zoe"));
}

TEST(ClusterRooms, AServerHearsOnlyWhomItsLinksWant) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& ann = cluster[0].add("ann");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  EXPECT_TRUE(cluster[1].listens_to("dance.1.pose.salsa.alice"));
  EXPECT_TRUE(cluster[1].listens_to("dance.1.pose.salsa.ann"));
  EXPECT_FALSE(cluster[0].listens_to("dance.1.pose.salsa.ann")) << "its own";
  Interest only_ann;
  only_ann.others = 0;
  ASSERT_TRUE(only_ann.guests.try_push({guest("ann"), 1}));
  b.link->set_interest(only_ann, cluster[1].tunnel.time_in(b));
  cluster.run(Duration::ms(300));
  EXPECT_FALSE(cluster[1].listens_to("dance.1.pose.salsa.alice"));
  EXPECT_TRUE(cluster[1].listens_to("dance.1.pose.salsa.ann"));
  b.poses.clear();
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&ann, "ann"}});
  EXPECT_EQ(b.heard_of(guest("alice")), 0u);
  EXPECT_GT(b.heard_of(guest("ann")), 55u);
  // One link that wants her is enough, and when that one has gone nobody does.
  House& carla = cluster[1].add("carla");
  cluster.run(Duration::ms(300));
  EXPECT_TRUE(cluster[1].listens_to("dance.1.pose.salsa.alice"));
  carla.link->send_goodbye();
  carla.is_running = false;
  cluster.run(Duration::ms(300));
  EXPECT_FALSE(cluster[1].listens_to("dance.1.pose.salsa.alice"));
}

TEST(ClusterRooms, StatesReachAllServersAndWhoComesLater) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  const auto say = [&](const auto& message) {
    a.link->send(guest("alice"), message, cluster[0].tunnel.time_in(a));
  };
  say(average_skeleton(1.7f));
  say(avatar_named("fox"));
  say(style_of(1.5f));
  say(placed_at(2.0f));
  say(scene_named("terrace"));
  cluster.run(Duration::ms(300));
  House& late = cluster[2].add("carla");
  cluster.run(Duration::ms(300));
  for (const House* house : {&b, &late}) {
    ASSERT_TRUE(house->avatars.contains(guest("alice")));
    EXPECT_EQ(house->avatars.at(guest("alice")).name, avatar_named("fox").name);
    ASSERT_TRUE(house->placements.contains(guest("alice")));
    EXPECT_EQ(house->placements.at(guest("alice")).x_m, 2.0f);
    ASSERT_TRUE(house->styles.contains(guest("alice")));
    EXPECT_FALSE(house->skeletons.empty());
    ASSERT_TRUE(house->scene);
    EXPECT_EQ(house->scene->second.name, scene_named("terrace").name);
    EXPECT_EQ(house->scene->first, guest("alice"));
  }
  // The newest holds, whoever sets it, at whichever server.
  b.link->send(guest("bob"), scene_named("cellar"), cluster[1].tunnel.time_in(b));
  cluster.run(Duration::ms(300));
  for (const House* house : {&a, &b, &late})
    EXPECT_EQ(house->scene->second.name, scene_named("cellar").name);
}

TEST(ClusterRooms, AGuestWhoLeavesLeavesEverywhere) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  ASSERT_TRUE(b.saw("+alice"));
  a.link->send_goodbye();
  a.is_running = false;
  cluster.run(Duration::ms(200));
  EXPECT_TRUE(b.saw("-alice"));
  for (const auto& [key, value] : cluster.values)
    EXPECT_EQ(key.find("alice"), std::string::npos) << key;
}

TEST(ClusterRooms, ARoomThatEmptiesLeavesNothingBehind) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  a.link->send(guest("alice"), scene_named("terrace"), cluster[0].tunnel.time_in(a));
  cluster.run(Duration::ms(200));
  EXPECT_FALSE(cluster.values.empty());
  for (House* house : {&a, &b}) {
    house->link->send_goodbye();
    house->is_running = false;
    cluster.run(Duration::ms(200));
  }
  EXPECT_TRUE(cluster.values.empty()) << cluster.values.begin()->first;
  EXPECT_EQ(cluster[0].subjects.size(), 2u) << "beats, and what is for it";
}

TEST(ClusterRooms, NinetyGuestsOfThreeServersHearEachOther) {
  SimulatedCluster cluster(3);
  std::vector<SimulatedCluster::Dancer> all;
  for (std::size_t i = 0; i < 90; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    all.emplace_back(&cluster[i % 3].add(name), name);
  }
  cluster.run(Duration::ms(500));
  cluster.dance(Duration::ms(800), all);
  cluster.run(Duration::ms(100));
  std::size_t highest = 0;
  for (const ServerRoom& room : cluster[0].tunnel.server().rooms())
    for (std::size_t slot = 0; slot < room.guests.size(); ++slot)
      if (room.in_use && room.guests[slot].in_use) highest = slot;
  EXPECT_GE(highest, wire::kSlotsPerPage) << "some are in the second page";
  for (const auto& [house, name] : all) {
    std::map<GuestId, int> heard;
    for (const auto& one : house->poses) ++heard[one.guest];
    EXPECT_EQ(heard.size(), 89u) << name;
    for (const auto& [other, poses] : heard) EXPECT_GE(poses, 40) << name << " of " << other.view();
  }
}

// It comes through another server, where the first page has a place for it.
TEST(ClusterRooms, AGuestOfTheSecondPageGoesOnThroughAnotherServer) {
  SimulatedCluster cluster(2);
  std::vector<SimulatedCluster::Dancer> all;
  for (std::size_t i = 0; i < 50; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    all.emplace_back(&cluster[i < 45 ? 0 : 1].add(name), name);
  }
  cluster.run(Duration::ms(500));
  House& last = *all[44].first;  // the 45th of the first server: at the second in the second page
  cluster.dance(Duration::ms(300), all);
  cluster[0].crash();
  cluster[1].tunnel.adopt(cluster[0].tunnel, last);
  cluster.run(Duration::ms(300));
  House& other = *all[49].first;
  other.poses.clear();
  cluster.dance(Duration::s(1), {{&last, "guest-44"}, {&other, "guest-49"}});
  EXPECT_GT(other.heard_of(guest("guest-44")), 50u);
  EXPECT_FALSE(other.saw("-guest-44"));
}

TEST(ClusterRooms, AHostAtAnyServerAloneSetsWhatAllShare) {
  SimulatedCluster cluster(2);
  House& host = cluster[0].tunnel.add_house("salsa", {"helen"}, {},
                                            {.name = guest("helen"), .role = Role::kHost});
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  host.link->send(guest("helen"), scene_named("terrace"), cluster.now());
  cluster.run(Duration::ms(300));
  b.link->send(guest("bob"), scene_named("cellar"), cluster.now());
  cluster.run(Duration::ms(500));
  ASSERT_FALSE(b.refused.empty());
  EXPECT_EQ(b.refused.front(), "scene not allowed");
  EXPECT_EQ(host.scene->second.name, scene_named("terrace").name);
  // When she has gone anybody may.
  host.link->send_goodbye();
  host.is_running = false;
  cluster.run(Duration::ms(300));
  b.link->send(guest("bob"), scene_named("attic"), cluster.now());
  cluster.run(Duration::ms(500));
  EXPECT_EQ(b.scene->second.name, scene_named("attic").name);
}

TEST(ClusterRooms, WhoFindsNoPlaceGetsOneWhenSomebodyLeaves) {
  SimulatedCluster cluster(3);
  std::vector<House*> houses;
  for (std::size_t i = 0; i < 135; ++i)
    houses.push_back(&cluster[i % 3].add("guest-" + std::to_string(i)));
  cluster.run(Duration::s(1));
  const ServerRoom* room = nullptr;
  for (const ServerRoom& each : cluster[0].tunnel.server().rooms())
    if (each.in_use) room = &each;
  ASSERT_NE(room, nullptr);
  EXPECT_LE(room->guest_count, wire::kMaxGuestsPerRoom);
  EXPECT_GE(room->guest_count, wire::kMaxGuestsPerRoom - 3);
  for (std::size_t i = 0; i < 30; ++i) {
    houses[i]->link->send_goodbye();
    houses[i]->is_running = false;
  }
  cluster.run(Duration::s(3));
  const auto here = std::ranges::count_if(
      houses, [](const House* house) { return house->is_running && house->link->is_connected(); });
  EXPECT_EQ(room->guest_count, static_cast<std::size_t>(here));
}

TEST(ClusterRooms, ANameIsTakenAtAllServers) {
  SimulatedCluster cluster(2);
  cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  House& other = cluster[1].add("alice");
  cluster.run(Duration::ms(300));
  EXPECT_TRUE(other.saw("refused 3 alice"));
  EXPECT_FALSE(b.saw("-alice"));
}

class ClusterReferences : public ::testing::Test {
 protected:
  House& add(SimulatedCluster::Site& site, const std::string& name) {
    logs.push_back(std::make_unique<ReferringLog>());
    use_referring_codec(site.tunnel.link_options, *logs.back());
    return site.add(name);
  }
  std::vector<std::unique_ptr<ReferringLog>> logs;
  SimulatedCluster cluster{3};
};

TEST_F(ClusterReferences, FramesThatReceiversOfAllServersHaveAreReferredTo) {
  House& a = add(cluster[0], "alice");
  House& near = add(cluster[0], "ann");
  House& b = add(cluster[1], "bob");
  House& c = add(cluster[2], "carla");
  cluster.run(Duration::ms(300));
  Random random{5};
  cluster[2].tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes) {
    return to_server || peer != c.peer || random.uniform() >= 0.2;
  };
  cluster.dance(Duration::s(5), {{&a, "alice"}});
  cluster.run(Duration::ms(200));
  const auto heard = [](const House& house) {
    std::set<std::uint32_t> sequences;
    for (const auto& one : house.poses) sequences.insert(one.pose.sequence);
    return sequences;
  };
  const auto at_near = heard(near), at_b = heard(b), at_c = heard(c);
  ASSERT_GT(logs[0]->acknowledged.size(), 80u);
  for (const std::uint32_t sequence : logs[0]->acknowledged) {
    EXPECT_TRUE(at_near.contains(sequence)) << sequence;
    EXPECT_TRUE(at_b.contains(sequence)) << sequence;
    EXPECT_TRUE(at_c.contains(sequence)) << sequence;
  }
  EXPECT_GE(at_b.size(), 305u);
  EXPECT_GT(at_c.size(), 200u);
  // Few intra frames do: who comes later, or has lost what is referred to, asks.
  EXPECT_LT(logs[0]->intra_frames_encoded, 40);
}

TEST_F(ClusterReferences, WhoComesLaterAtAnotherServerNeedsOneIntraFrame) {
  House& a = add(cluster[0], "alice");
  add(cluster[1], "bob");
  cluster.run(Duration::ms(300));
  cluster.dance(Duration::s(2), {{&a, "alice"}});
  const int before = logs[0]->intra_frames_encoded;
  House& late = add(cluster[2], "carla");
  cluster.dance(Duration::s(1), {{&a, "alice"}});
  EXPECT_GT(late.heard_of(guest("alice")), 50u);
  EXPECT_LE(logs[0]->intra_frames_encoded - before, 3);
}

TEST(ClusterRooms, WhoIsThereIsToldByAServerThroughWhichSomebodyIs) {
  SimulatedCluster cluster(2);
  cluster[0].add("alice");
  cluster[1].add("bob");
  cluster[1].add("dora", "tango");
  cluster.run(Duration::ms(500));
  std::vector<wire::RoomAnswer> answers;
  SimulatedTunnel& tunnel = cluster[0].tunnel;
  tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (!to_server && opening->type == wire::Type::kRoomAnswer)
      answers.push_back(*wire::parse_room_answer(opening->body));
    return true;
  };
  const PeerId asking = tunnel.add_peer({.name = guest("emil")});
  for (const char* room : {"salsa", "tango"}) {
    std::array<std::uint8_t, 64> out;
    tunnel.inject(asking, {out.data(), wire::build(wire::RoomQuestion{1, guest(room)}, out)});
  }
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].result, wire::RoomResult::kKnown);
  EXPECT_EQ(answers[0].count, 2) << "those who came through other servers, too";
  EXPECT_EQ(answers[1].result, wire::RoomResult::kNotHere)
      << "no answer is better than a wrong one";
}

TEST(ClusterRooms, WhoIsThereIsNotToldUntilTheOtherServersHaveBeenHeard) {
  SimulatedCluster cluster(2);
  cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  std::vector<wire::RoomAnswer> answers;
  SimulatedTunnel& tunnel = cluster[0].tunnel;
  cluster.cut(0);
  cluster[0].add("alice");
  cluster.run(Duration::ms(300));
  tunnel.on_datagram = [&](bool to_server, PeerId, wire::Bytes bytes) {
    const auto opening = wire::parse_opening(bytes);
    if (!to_server && opening->type == wire::Type::kRoomAnswer)
      answers.push_back(*wire::parse_room_answer(opening->body));
    return true;
  };
  const PeerId asking = tunnel.add_peer({.name = guest("emil")});
  std::array<std::uint8_t, 64> out;
  const std::size_t size = wire::build(wire::RoomQuestion{1, guest("salsa")}, out);
  tunnel.inject(asking, {out.data(), size});
  cluster.join(0);
  cluster.run(Duration::ms(500));
  tunnel.inject(asking, {out.data(), size});
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_EQ(answers[0].result, wire::RoomResult::kNotHere) << "alice alone would be wrong";
  EXPECT_EQ(answers[1].result, wire::RoomResult::kKnown);
  EXPECT_EQ(answers[1].count, 2);
}

TEST(ClusterRooms, GuestsOfOneKeyAreCountedAtAllServers) {
  SimulatedCluster cluster(2);
  const Access key{.name = guest("mallory")};
  std::vector<std::string> names;
  for (int i = 0; i < 16; ++i) names.push_back("mallory-" + std::to_string(i));
  House& first = cluster[0].tunnel.add_house("salsa", names, {}, key);
  cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  EXPECT_TRUE(first.link->is_connected());
  House& second = cluster[1].tunnel.add_house("salsa", {"mallory-16"}, {}, key);
  House& alice = cluster[1].tunnel.add_house("salsa", {"alice"}, {}, {.name = guest("alice")});
  cluster.run(Duration::ms(300));
  EXPECT_FALSE(second.link->is_connected());
  EXPECT_TRUE(second.saw("refused 15 "));
  EXPECT_TRUE(alice.link->is_connected());
}

TEST(ClusterRooms, SimultaneousJoinsWithOneKeyTakeNoMoreThanItsPlaces) {
  SimulatedCluster cluster(4);
  for (std::size_t i = 0; i < 4; ++i) cluster[i].add("bob-" + std::to_string(i));
  cluster.run(Duration::ms(300));
  for (std::size_t i = 0; i < 4; ++i) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < 16; ++k) names.push_back("mallory-" + std::to_string(16 * i + k));
    cluster[i].tunnel.add_house("salsa", names, {}, {.name = guest("mallory")});
  }
  cluster.run(Duration::s(1));
  for (std::size_t i = 0; i < 4; ++i) {
    const ServerRoom& room = cluster[i].tunnel.server().rooms()[0];
    ASSERT_TRUE(room.in_use);
    EXPECT_EQ(room.guest_count, 4u + 16u) << i;
  }
}

}  // namespace
}  // namespace dance
