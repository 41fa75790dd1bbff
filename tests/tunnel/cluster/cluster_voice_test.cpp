// Voices of guests of one room through several servers.
#include <gtest/gtest.h>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tests/tunnel/voice/voices.h"

namespace dance {
namespace {

using House = SimulatedTunnel::House;

TEST(ClusterVoice, GuestsOfAllServersHearEachOther) {
  SimulatedCluster cluster(3);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  House& c = cluster[2].add("carla");
  House& beside = cluster[0].add("ann");
  House& elsewhere = cluster[1].add("dora", "tango");
  cluster.run(Duration::ms(300));
  Talk talk{cluster[0].tunnel, {{&a, guest("alice"), -14}}};
  cluster[0].published.clear();
  cluster.run(Duration::s(1), [&] {
    if (cluster.now().since_zero_us() / 1000 % 10 == 0) talk.say(talk.talkers[0]);
  });
  cluster.run(Duration::ms(50));
  for (const House* house : {&b, &c, &beside}) {
    ASSERT_EQ(house->voices.size(), 100u);
    const House::HeardVoice& last = house->voices.back();
    EXPECT_EQ(last.guest, guest("alice"));
    EXPECT_EQ(last.voice.sequence, 100u);
    EXPECT_EQ(last.voice.level_dbfs, -14);
    EXPECT_EQ(last.voice.data, voice_number(100, {}, 0).data);
    EXPECT_EQ(last.voice.clock_id, house->clock_id);
    EXPECT_LE((last.at - last.voice.capture_time).as_ms(), 26.0);
  }
  EXPECT_TRUE(elsewhere.voices.empty());
  EXPECT_EQ(cluster[0].published["dance.1.voice"], 100) << "once each, for both servers";
}

TEST(ClusterVoice, LinksOfOneKeyAtSeveralServersHaveOnePlace) {
  SimulatedCluster cluster(3);
  House& listener = cluster[0].add("bob");
  const Access key{.name = guest("mallory")};
  std::vector<Talk> talks;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "mallory-" + std::to_string(i);
    House& house = cluster[i].tunnel.add_house("salsa", {name}, {}, key);
    talks.push_back(Talk{cluster[i].tunnel, {{&house, guest(name)}}});
  }
  cluster.run(Duration::ms(300));
  cluster.run(Duration::s(1), [&] {
    if (cluster.now().since_zero_us() / 1000 % 10 != 0) return;
    for (Talk& talk : talks) talk.say(talk.talkers[0]);
  });
  cluster.run(Duration::ms(50));
  EXPECT_EQ(listener.voices.size(), 100u);
}

TEST(ClusterVoice, GoesOnlyToServersThatWantTheGuest) {
  SimulatedCluster cluster(2);
  House& a = cluster[0].add("alice");
  House& b = cluster[1].add("bob");
  cluster.run(Duration::ms(300));
  Interest nobody;
  nobody.others = 0;
  b.link->set_interest(nobody, cluster[1].tunnel.time_in(b));
  cluster.run(Duration::ms(300));
  Talk talk{cluster[0].tunnel, {{&a, guest("alice")}}};
  const std::uint64_t before = cluster[1].node->counters().voices_in;
  cluster.run(Duration::ms(300), [&] { talk.say(talk.talkers[0]); });
  EXPECT_TRUE(b.voices.empty());
  EXPECT_EQ(cluster[1].node->counters().voices_in, before);
}

}  // namespace
}  // namespace dance
