// What a server tells of its cluster, and what the doctor's probe hears, against what really passes
// between simulated servers.
#include "tunnel/server/program/cluster/cluster_status.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tunnel/cluster/simulated_cluster.h"
#include "tunnel/cluster/cluster_probe.h"
#include "tunnel/server/program/server_metrics.h"
#include "tunnel/server/program/server_status.h"

namespace dance {
namespace {

TEST(ClusterStatus, TellsTheOtherServersAndWhatPassesInEachRoom) {
  SimulatedCluster cluster(2);
  auto& alice = cluster[0].add("alice");
  auto& bob = cluster[1].add("bob");
  cluster.dance(Duration::s(2), {{&alice, "alice"}, {&bob, "bob"}});
  const ClusterStatus status =
      cluster_status_of(*cluster[0].node, cluster[0].tunnel.server(), cluster.now());
  EXPECT_EQ(status.id, cluster[0].node->id());
  EXPECT_EQ(status.clock_server, cluster[0].node->id()) << "it was there first";
  EXPECT_EQ(status.guests, 1u);
  ASSERT_EQ(status.peers.size(), 1u);
  const ClusterPeerStatus& peer = status.peers[0];
  EXPECT_EQ(peer.id, cluster[1].node->id());
  EXPECT_TRUE(peer.is_alive);
  EXPECT_EQ(peer.guests, 1u);
  EXPECT_LT(peer.last_heard, Duration::ms(250));
  EXPECT_TRUE(peer.round_trip);
  ASSERT_EQ(status.between.size(), 1u);
  const ClusterLinkStatus& link = status.between[0];
  EXPECT_EQ(link.room, guest("salsa"));
  EXPECT_EQ(link.peer, peer.id);
  EXPECT_EQ(link.guests, 1u);
  // Every pose that one server published is one that the other took.
  const ClusterStatus other =
      cluster_status_of(*cluster[1].node, cluster[1].tunnel.server(), cluster.now());
  ASSERT_EQ(other.between.size(), 1u);
  EXPECT_GT(link.meter.records_out, 90u);
  EXPECT_NEAR(static_cast<double>(other.between[0].meter.records_in),
              static_cast<double>(link.meter.records_out), 3.0);
  EXPECT_NEAR(static_cast<double>(link.meter.records_in),
              static_cast<double>(other.between[0].meter.records_out), 3.0);
  EXPECT_EQ(status.node.records_out, link.meter.records_out) << "there is one other server";
  EXPECT_GT(link.meter.feedback_in, 0u);
  EXPECT_GT(link.meter.feedback_out, 0u);
  EXPECT_GT(status.node.bytes_out, 47 * status.node.records_out);
  EXPECT_EQ(link.poses_lost, 0u);

  ServerStatus whole;
  whole.cluster = status;
  const auto json = nlohmann::json::parse(to_json(whole), nullptr, false);
  ASSERT_TRUE(json.is_object()) << to_json(whole);
  EXPECT_EQ(json["cluster"]["servers"][0]["id"], server_id_text(peer.id));
  EXPECT_EQ(json["cluster"]["between"][0]["records_out"], link.meter.records_out);
  if (!ServerMetrics::is_built()) return;
  const std::string page = metrics_text(whole);
  EXPECT_NE(page.find("dance_server_cluster_room_records_sent_total{room=\"salsa\",server=\"" +
                      server_id_text(peer.id) + "\"} " + std::to_string(link.meter.records_out)),
            std::string::npos)
      << page;
}

TEST(ClusterStatus, ASilentServerIsGone) {
  SimulatedCluster cluster(2);
  cluster[1].crash();
  cluster.run(Duration::s(2));
  const ClusterStatus status =
      cluster_status_of(*cluster[0].node, cluster[0].tunnel.server(), cluster.now());
  ASSERT_EQ(status.peers.size(), 1u);
  EXPECT_FALSE(status.peers[0].is_alive);
  EXPECT_GT(status.peers[0].last_heard, Duration::ms(900));
  EXPECT_EQ(status.deaths, 1u);
}

// A bus whose other end is the test.
class TestBus final : public ClusterBus {
 public:
  void set_handlers(Handlers given) override { handlers = std::move(given); }
  void publish(std::string_view subject, Bytes message) override {
    published.emplace_back(subject, std::vector<std::uint8_t>(message.begin(), message.end()));
  }
  void listen(std::string_view) override {}
  void end_listen(std::string_view) override {}
  void put(std::string_view, Bytes) override { FAIL() << "it only listens"; }
  void erase(std::string_view) override { FAIL() << "it only listens"; }
  void watch(std::string_view) override {}
  void end_watch(std::string_view) override {}

  void say(const cluster::Message& message, MonoTime now) {
    std::array<std::uint8_t, cluster::kMaxBytes> bytes;
    handlers.on_message("", {bytes.data(), cluster::build(message, bytes)}, now);
  }

  Handlers handlers;
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> published;
};

TEST(ClusterProbe, MeasuresTheClockOfWhoBeatsByTheShortestRoundTrip) {
  TestBus bus;
  ClusterProbe probe(99, bus);
  cluster::Heartbeat beat;
  beat.server = 7;
  MonoTime now = MonoTime::from_us(1'000'000);
  bus.say(beat, now);
  // Its clock is 5 ms ahead; the way there takes 1 ms, the way back 1, 9 and 3 ms.
  for (const std::int64_t back_us : {9000, 1000, 3000}) {
    bus.published.clear();
    probe.tick(now);
    ASSERT_EQ(bus.published.size(), 1u);
    EXPECT_EQ(bus.published[0].first, cluster::server_subject(7).view());
    const std::int64_t asked_us = now.since_zero_us();
    now += Duration::us(1000 + back_us);
    bus.say(cluster::ClockAnswer{7, asked_us, asked_us + 6000, asked_us + 6000}, now);
  }
  ASSERT_EQ(probe.seen().size(), 1u);
  const ClusterProbe::Seen& seen = probe.seen().at(7);
  EXPECT_EQ(seen.answers, 3u);
  EXPECT_EQ(seen.offset, Duration::ms(5));
  EXPECT_EQ(seen.round_trip, Duration::ms(2));
  // Answers of the past, of the future, and of servers without heartbeats do not count.
  bus.say(cluster::ClockAnswer{7, now.since_zero_us() - 5'000'000, 0, 0}, now);
  bus.say(cluster::ClockAnswer{7, now.since_zero_us() + 1, 0, 0}, now);
  bus.say(cluster::ClockAnswer{8, now.since_zero_us(), 0, 0}, now);
  EXPECT_EQ(probe.seen().at(7).answers, 3u);
  EXPECT_EQ(probe.seen().size(), 1u);
  beat.is_leaving = true;
  bus.say(beat, now);
  EXPECT_TRUE(probe.seen().empty());
}

}  // namespace
}  // namespace dance
