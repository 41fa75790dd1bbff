// Tests that shown names pass between the servers of a cluster, and to guests who join later.
#include <gtest/gtest.h>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tunnel/session/profile_bytes.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

std::string last_name(const House& house) {
  std::string name;
  for (const auto& message : house.channels) {
    const auto profile = parse_profile(message.bytes);
    if (message.name == "NAMES/alice" && profile) name = profile->shown_name.view();
  }
  return name;
}

TEST(ClusterProfile, ReachesAllServersAndGuestsWhoJoinLater) {
  SimulatedCluster cluster(3);
  const auto rule = ChannelRule::parse("NAMES/* class=state size=41 rate=2 layout=bytes[41]");
  ASSERT_TRUE(rule) << rule.error().what;
  for (std::size_t i = 0; i < 3; ++i) {
    auto& channels = cluster[i].tunnel.link_options.channels;
    channels = {*rule};
    channels[0].layout = *LayoutCheck::parse("any");
  }
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  const auto show = [&](const char* name) {
    ProfileBytes bytes;
    Profile profile;
    profile.shown_name = *parse_shown_name(name);
    const std::size_t size = write_profile(profile, bytes);
    a.link->send_channel("NAMES/alice", {bytes.data(), size}, cluster[0].tunnel.time_in(a),
                         guest("alice"));
  };
  show("Alicia");
  cluster.run(Duration::ms(300));
  House& late = cluster[2].add("carla");
  cluster.run(Duration::ms(300));
  EXPECT_EQ(last_name(b), "Alicia");
  EXPECT_EQ(last_name(late), "Alicia");
  cluster.run(Duration::s(1));
  show("Alicia L\u00f3pez");
  cluster.run(Duration::s(1));
  EXPECT_EQ(last_name(b), "Alicia L\u00f3pez");
  EXPECT_EQ(last_name(late), "Alicia L\u00f3pez");
}

}  // namespace
}  // namespace dance
