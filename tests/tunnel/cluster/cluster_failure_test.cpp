// Servers die, are cut off, and come back; the dance at the others goes on.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tests/tunnel/states_scene.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

TEST(ClusterFailure, AGuestOfADeadServerComesBackThroughAnotherWithoutLeaving) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  House& c = cluster[2].add("carla");
  cluster.run(Duration::ms(300));
  a.link->send(guest("alice"), placed_at(2.0f), cluster[0].tunnel.time_in(a));
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&b, "bob"}, {&c, "carla"}});
  cluster[0].crash();
  cluster.dance(Duration::ms(600), {{&b, "bob"}, {&c, "carla"}});
  cluster[1].tunnel.adopt(cluster[0].tunnel, a);
  const std::size_t before_b = b.heard_of(guest("alice")), before_c = c.heard_of(guest("alice"));
  const std::size_t before_a = a.heard_of(guest("carla"));
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&b, "bob"}, {&c, "carla"}});
  for (const House* house : {&b, &c}) EXPECT_FALSE(house->saw("-alice"));
  EXPECT_GT(b.heard_of(guest("alice")), before_b + 50);
  EXPECT_GT(c.heard_of(guest("alice")), before_c + 50);
  EXPECT_GT(a.heard_of(guest("carla")), before_a + 50);
  // Its states stand for who comes now.
  House& late = cluster[2].add("dora");
  cluster.run(Duration::s(8));
  EXPECT_EQ(late.placements[guest("alice")].x_m, 2.0f);
  EXPECT_FALSE(c.saw("-alice")) << "nor when the dead server is forgotten";
  EXPECT_FALSE(b.saw("-alice"));
}

TEST(ClusterFailure, WhoComesToAServerWithoutTheRoomSeesNobodyLeave) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  ASSERT_TRUE(a.saw("+bob"));
  cluster[0].crash();
  cluster.delay = Duration::ms(50);
  cluster[2].tunnel.adopt(cluster[0].tunnel, a);
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&b, "bob"}});
  EXPECT_FALSE(a.saw("-bob"));
  EXPECT_FALSE(b.saw("-alice"));
  EXPECT_GT(a.heard_of(guest("bob")), 40u);
}

// Nobody died: a nearer server was found. The one before hears of it while it still has the link.
TEST(ClusterFailure, TheOnlyGuestOfAServerMayGoToAnotherThatLives) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  cluster.run(Duration::ms(300));
  a.link->send(guest("alice"), placed_at(2.0f), cluster[0].tunnel.time_in(a));
  cluster.dance(Duration::ms(300), {{&a, "alice"}});
  cluster[1].tunnel.adopt(cluster[0].tunnel, a);
  cluster.dance(Duration::ms(500), {{&a, "alice"}});
  EXPECT_EQ(cluster[0].tunnel.server().room_count(), 0u);
  EXPECT_EQ(cluster[0].tunnel.server().guest_count(), 0u);
  House& b = cluster[0].add("bob");
  cluster.run(Duration::ms(300));
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&b, "bob"}});
  EXPECT_GT(b.heard_of(guest("alice")), 55u);
  EXPECT_GT(a.heard_of(guest("bob")), 55u);
}

// Another process of the same guest: who was there before holds the name, and then the other.
TEST(ClusterFailure, ARestartedHouseThatComesToAnotherServerLeavesNoTrace) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  cluster.run(Duration::ms(300));
  a.is_running = false;  // its server does not know yet
  cluster.run(Duration::ms(1));
  House& again = cluster[1].add("alice");
  cluster.run(Duration::s(6));
  EXPECT_EQ(cluster[0].tunnel.server().guest_count(), 0u);
  EXPECT_EQ(cluster[1].tunnel.server().guest_count(), 1u);
  for (std::size_t i = 0; i < 2; ++i)
    for (const ServerRoom& room : cluster[i].tunnel.server().rooms())
      EXPECT_EQ(std::ranges::count_if(room.guests, [](const auto& it) { return it.in_use; }),
                static_cast<std::ptrdiff_t>(room.in_use ? room.guest_count : 0));
  House& b = cluster[0].add("bob");
  cluster.run(Duration::ms(300));
  cluster.dance(Duration::s(1), {{&again, "alice"}, {&b, "bob"}});
  EXPECT_GT(b.heard_of(guest("alice")), 55u);
}

// As when a server died between two writes: a guest stands there, and no presence of its server.
TEST(ClusterFailure, AGuestOfAServerThatNeverWasLeaves) {
  SimulatedCluster cluster(2);
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  cluster::GuestValue value;
  value.server = 4711;
  value.link_token = 5;
  value.since_us = cluster.now().since_zero_us();
  value.codec = known_codecs().front();
  std::vector<std::uint8_t> bytes(cluster::kMaxBytes);
  bytes.resize(cluster::build(cluster::Value(value), bytes));
  cluster[0].put("salsa.guest.alice", bytes);
  cluster.run(Duration::ms(300));
  EXPECT_TRUE(b.saw("+alice"));
  cluster.run(Duration::s(8));
  EXPECT_TRUE(b.saw("-alice"));
  EXPECT_FALSE(cluster.values.contains("salsa.guest.alice"));
}

TEST(ClusterFailure, WhoDoesNotComeBackLeavesAndLeavesNothing) {
  SimulatedCluster cluster(2);
  cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  cluster[0].crash();
  cluster.run(Duration::s(3));
  EXPECT_FALSE(b.saw("-alice"));
  cluster.run(Duration::s(5));
  EXPECT_TRUE(b.saw("-alice"));
  for (const auto& [key, value] : cluster.values)
    EXPECT_EQ(key.find("alice"), std::string::npos) << key;
}

TEST(ClusterFailure, TheNameOfADeadServersGuestIsFreeForAnotherLink) {
  SimulatedCluster cluster(3);
  cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  House& c = cluster[2].add("carla");
  cluster.run(Duration::ms(300));
  cluster[0].crash();
  cluster.run(Duration::ms(1200));
  House& again = cluster[1].add("alice");
  cluster.run(Duration::ms(400));
  cluster.dance(Duration::s(1), {{&again, "alice"}});
  EXPECT_GT(b.heard_of(guest("alice")), 50u);
  EXPECT_GT(c.heard_of(guest("alice")), 50u);
  cluster.run(Duration::s(8));
  cluster.dance(Duration::s(1), {{&again, "alice"}});
  EXPECT_GT(c.heard_of(guest("alice")), 100u) << "when the dead server is forgotten too";
}

TEST(ClusterFailure, ARoomsStateOutlivesItsServer) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  cluster.run(Duration::ms(300));
  a.link->send(guest("alice"), scene_named("terrace"), cluster[0].tunnel.time_in(a));
  cluster.run(Duration::ms(300));
  cluster[0].crash();
  cluster[1].tunnel.adopt(cluster[0].tunnel, a);
  cluster.run(Duration::ms(500));
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(500));
  ASSERT_TRUE(b.scene);
  EXPECT_EQ(b.scene->second.name, scene_named("terrace").name);
}

TEST(ClusterFailure, AServerThatEndsHandsItsGuestsOnAtOnce) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  cluster[0].node->leave();
  cluster[0].crash();
  cluster.run(Duration::ms(20));
  cluster[1].tunnel.adopt(cluster[0].tunnel, a);
  cluster.dance(Duration::s(1), {{&a, "alice"}, {&b, "bob"}});
  EXPECT_GT(b.heard_of(guest("alice")), 45u);
  EXPECT_GT(a.heard_of(guest("bob")), 45u);
  EXPECT_FALSE(b.saw("-alice"));
}

TEST(ClusterFailure, APartitionHealsWhollyByItself) {
  for (const int seconds : {1, 3, 20}) {
    SimulatedCluster cluster(3);
    House& a = cluster[0].add("alice");
    House& b = cluster[1].add("bob");
    House& c = cluster[2].add("carla");
    const std::vector<SimulatedCluster::Dancer> all{{&a, "alice"}, {&b, "bob"}, {&c, "carla"}};
    cluster.run(Duration::ms(300));
    cluster.cut(1);
    cluster.dance(Duration::s(seconds), all);
    const std::size_t between = a.heard_of(guest("carla"));
    EXPECT_GT(between, static_cast<std::size_t>(50 * seconds)) << "the others go on";
    cluster.join(1);
    cluster.run(Duration::s(2));
    for (House* house : {&a, &b, &c}) house->poses.clear();
    cluster.dance(Duration::s(2), all);
    for (const auto& [house, own] : all)
      for (const char* name : {"alice", "bob", "carla"}) {
        if (own == name) continue;
        EXPECT_GT(house->heard_of(guest(name)), 100u) << own << " of " << name << ", " << seconds;
      }
  }
}

// What the others erased during a partition is written again, also where its server was not told.
TEST(ClusterFailure, WhoWasErasedDuringAPartitionIsThereAgain) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  const std::vector<SimulatedCluster::Dancer> all{{&a, "alice"}, {&b, "bob"}};
  cluster.run(Duration::ms(300));
  cluster.cut(1);
  cluster.dance(Duration::s(10), all);
  ASSERT_GT(std::erase_if(cluster[1].arrivals, [](const auto& it) { return it.is_value; }), 0u);
  cluster.join(1);
  cluster.dance(Duration::s(10), all);
  for (House* house : {&a, &b}) house->poses.clear();
  cluster.dance(Duration::s(2), all);
  EXPECT_GT(a.heard_of(guest("bob")), 100u);
  EXPECT_GT(b.heard_of(guest("alice")), 100u);
}

// One that the others took for dead: what they erase may come after it has written all again, its
// guests first.
TEST(ClusterFailure, WhoseServersPresenceIsErasedLateStays) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  const std::vector<SimulatedCluster::Dancer> all{{&a, "alice"}, {&b, "bob"}};
  cluster.run(Duration::ms(300));
  const cluster::Key of{cluster::KeyKind::kPresence, guest("salsa"), cluster[1].node->id(), {}, 0};
  const std::string presence(cluster::text_of(of).view());
  ASSERT_TRUE(cluster.values.contains(presence));
  cluster[0].erase(presence);
  cluster.dance(Duration::s(1), all);
  for (House* house : {&a, &b}) house->poses.clear();
  cluster.dance(Duration::s(2), all);
  EXPECT_GT(a.heard_of(guest("bob")), 100u);
  EXPECT_GT(b.heard_of(guest("alice")), 100u);
}

// A bucket takes what waited in no order, and some of it long after the servers hear each other.
TEST(ClusterFailure, InWhateverOrderWhatWaitedIsWrittenAllHearAll) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    Random random(seed);
    SimulatedCluster cluster(3);
    std::vector<SimulatedCluster::Dancer> all;
    for (int i = 0; i < 6; ++i) {
      const std::string name = "guest-" + std::to_string(i);
      all.emplace_back(&cluster[static_cast<std::size_t>(i % 3)].add(name), name);
    }
    cluster.run(Duration::ms(300));
    for (const std::size_t site : {0u, 1u, 2u}) cluster.cut(site);
    cluster.run(Duration::ms(500 + static_cast<std::int64_t>(random.below(12'000))));
    for (const std::size_t site : {0u, 1u, 2u}) cluster.join(site, Duration::s(20), random);
    cluster.run(Duration::s(21));
    for (const auto& [house, name] : all) house->poses.clear();
    cluster.dance(Duration::s(1), all);
    for (const auto& [house, own] : all)
      for (const auto& [other, name] : all) {
        if (own == name) continue;
        EXPECT_GT(house->heard_of(guest(name)), 40u) << own << " of " << name << ", seed " << seed;
      }
  }
}

// However servers die and guests wander, when it is quiet all hear all, and nothing is left over.
TEST(ClusterFailure, ManyDeathsInARowLeaveOneRoom) {
  SimulatedCluster cluster(3);
  Random random(11);
  std::vector<SimulatedCluster::Dancer> all;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "guest-" + std::to_string(i);
    all.emplace_back(&cluster[static_cast<std::size_t>(i % 3)].add(name), name);
  }
  cluster.run(Duration::ms(300));
  for (int kill = 0; kill < 30; ++kill) {
    const std::size_t dead = random.next_u64() % 3;
    cluster[dead].crash();
    cluster.dance(Duration::ms(static_cast<std::int64_t>(random.next_u64() % 1500)), all);
    for (const auto& [house, name] : all)
      if (cluster[dead].tunnel.has(*house))
        cluster[(dead + 1 + random.next_u64() % 2) % 3].tunnel.adopt(cluster[dead].tunnel, *house);
    cluster.dance(Duration::ms(static_cast<std::int64_t>(random.next_u64() % 3000)), all);
    cluster[dead].restart();
    cluster.dance(Duration::ms(static_cast<std::int64_t>(random.next_u64() % 2000)), all);
  }
  cluster.run(Duration::s(10));
  for (const auto& [house, name] : all) house->poses.clear();
  cluster.dance(Duration::s(2), all);
  for (const auto& [house, own] : all)
    for (const auto& [other, name] : all) {
      if (own == name) continue;
      EXPECT_GT(house->heard_of(guest(name)), 100u) << own << " of " << name;
    }
  const auto guests = std::count_if(cluster.values.begin(), cluster.values.end(), [](auto& value) {
    return value.first.find(".guest.") != std::string::npos;
  });
  EXPECT_EQ(guests, 6);
  const auto servers = std::count_if(cluster.values.begin(), cluster.values.end(), [](auto& value) {
    return value.first.find(".at.") != std::string::npos;
  });
  EXPECT_LE(servers, 3);
}

}  // namespace
}  // namespace dance
