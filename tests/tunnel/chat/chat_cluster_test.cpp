// Lines pass between the servers of a cluster once. A guest who moves to another server repeats
// none.
#include <gtest/gtest.h>

#include "tests/tunnel/cluster/simulated_cluster.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

std::vector<std::string> lines_of(const House& house) {
  std::vector<std::string> lines;
  for (const auto& [guest, chat] : house.chats) lines.emplace_back(chat.text.view());
  return lines;
}

TEST(ClusterChat, LinesReachTheGuestsOfAllServersOnce) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  House& c = cluster[2].add("carla");
  cluster.run(Duration::ms(500));
  std::vector<std::string> expected;
  for (int i = 0; i < 6; ++i) {
    Chat chat;
    chat.time = cluster[0].tunnel.time_in(a);
    chat.clock_id = a.clock_id;
    expected.push_back("line " + std::to_string(i));
    ASSERT_TRUE(chat.text.assign(expected.back()));
    a.link->send(guest("alice"), chat, chat.time);
    cluster.run(Duration::ms(1100));
  }
  EXPECT_EQ(lines_of(b), expected);
  EXPECT_EQ(lines_of(c), expected);
  EXPECT_TRUE(a.chats.empty());
  House& late = cluster[1].add("dora");
  cluster.run(Duration::s(1));
  EXPECT_EQ(lines_of(late), (std::vector<std::string>{"line 2", "line 3", "line 4", "line 5"}));
}

}  // namespace
}  // namespace dance
