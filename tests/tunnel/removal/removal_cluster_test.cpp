// Removals through several servers.
#include <gtest/gtest.h>

#include "tests/tunnel/cluster/simulated_cluster.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

bool is_at(SimulatedCluster::Site& site, const char* name) {
  for (const ServerRoom& room : site.tunnel.server().rooms())
    for (const ServerGuest& there : room.guests)
      if (room.in_use && there.in_use && there.id == guest(name)) return true;
  return false;
}

struct ThreeServers {
  ThreeServers() {
    host = &cluster[0].tunnel.add_house("salsa", {"hanna"}, {},
                                        {.name = guest("hanna"), .role = Role::kHost});
    bob = &cluster[1].tunnel.add_house("salsa", {"bob"}, {}, {.name = guest("bob")});
    carla = &cluster[2].tunnel.add_house("salsa", {"carla"}, {}, {.name = guest("carla")});
    cluster.run(Duration::ms(600));
  }
  SimulatedCluster cluster{3};
  House* host;
  House* bob;
  House* carla;
};

TEST(ClusterRemoval, ReachesTheServerOfTheGuest) {
  ThreeServers at;
  ASSERT_TRUE(is_at(at.cluster[0], "bob"));
  at.host->link->ask_removal(guest("bob"), 3);
  at.cluster.run(Duration::ms(200));
  EXPECT_TRUE(at.host->saw("removal 3 4")) << "passed on";
  EXPECT_TRUE(at.bob->saw("refused 11 "));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(is_at(at.cluster[i], "bob")) << i;
  EXPECT_TRUE(at.carla->saw("-bob"));
  EXPECT_TRUE(is_at(at.cluster[0], "carla"));
}

TEST(ClusterRemoval, NoOtherServerLetsTheGuestIn) {
  ThreeServers at;
  at.host->link->ask_removal(guest("bob"), 3);
  at.cluster.run(Duration::ms(200));
  for (std::size_t i = 0; i < 3; ++i) {
    House& again = at.cluster[i].tunnel.add_house("salsa", {"bob-2"}, {}, {.name = guest("bob")});
    at.cluster.run(Duration::s(1));
    EXPECT_TRUE(again.saw("refused 11 ")) << i;
    again.is_running = false;
  }
  EXPECT_FALSE(is_at(at.cluster[0], "bob-2"));
}

TEST(ClusterRemoval, FollowsALinkThatHasGoneToAnotherServerMeanwhile) {
  ThreeServers at;
  at.cluster.delay = Duration::ms(150);
  at.host->link->ask_removal(guest("bob"), 3);
  // Before the servers hear of it, the link is with another one.
  at.cluster.run(Duration::ms(20));
  at.cluster[2].tunnel.adopt(at.cluster[1].tunnel, *at.bob);
  at.cluster.run(Duration::s(2));
  EXPECT_TRUE(at.bob->saw("refused 11 "));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(is_at(at.cluster[i], "bob")) << i;
}

}  // namespace
}  // namespace dance
