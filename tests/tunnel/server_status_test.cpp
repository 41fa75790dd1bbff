// What the server tells of itself, against what really passes through a simulated tunnel.
#include "tunnel/server/program/server_status.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/allocation_guard.h"
#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/server/program/server_metrics.h"
#include "tunnel/session/arrival_jitter.h"

namespace dance {
namespace {

TEST(ArrivalJitter, IsThatOfTheStandard) {
  ArrivalJitter jitter;
  EXPECT_FALSE(jitter.has_any());
  // Sent each 20 ms, on their way for 5, 5, 9 and 7 ms.
  const std::array<std::int64_t, 4> way_us{5000, 5000, 9000, 7000};
  double expected_us = 0.0;
  for (std::size_t i = 0; i < way_us.size(); ++i) {
    const auto sent_us = static_cast<std::int64_t>(i) * 20'000;
    jitter.add(sent_us, sent_us + way_us[i]);
    if (i == 0) continue;
    const double change_us = std::abs(static_cast<double>(way_us[i] - way_us[i - 1]));
    expected_us += (change_us - expected_us) / 16.0;
  }
  EXPECT_NEAR(jitter.jitter().as_us(), expected_us, 0.01);
  EXPECT_NEAR(expected_us, 4000.0 / 16 * 15 / 16 + 2000.0 / 16, 1e-9);
}

class StatusTest : public ::testing::Test {
 protected:
  StatusTest() : maker(make_maker({})) {}

  ServerStatusMaker make_maker(const ServerLimits& limits) {
    return {tunnel.server(), limits, "127.0.0.1:7400",
            [](const ServerSession&) { return std::string("somewhere"); }, tunnel.now()};
  }
  // The maker samples as the server lets it: once a second.
  void run(Dance& dance, int seconds) {
    for (int i = 0; i < seconds; ++i) {
      dance.run(Duration::s(1));
      maker.sample(tunnel.now());
    }
  }
  ServerStatus status() const { return maker.make(tunnel.now(), handshakes); }

  SimulatedTunnel tunnel{{.repeats = false}};  // so that what is lost is what the line loses
  ServerStatusMaker maker;
  std::vector<NamedCount> handshakes;
};

TEST_F(StatusTest, TellsRoomsGuestsAndListeners) {
  auto& a = tunnel.add_house("salsa", {"alice", "anna"});
  tunnel.add_house("salsa", {});
  tunnel.add_house("tango", {"tom"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 8);
  const ServerStatus now = status();
  EXPECT_EQ(now.version, server_version());
  EXPECT_EQ(now.uptime, Duration::s(8));
  ASSERT_EQ(now.rooms.size(), 2u);
  const ServerRoomStatus& salsa = now.rooms[0];
  EXPECT_EQ(salsa.name, guest("salsa"));
  EXPECT_EQ(salsa.guests, 2u);
  EXPECT_EQ(salsa.listeners, 1u);
  EXPECT_EQ(codec_text(salsa.codec), "lattice");
  EXPECT_EQ(salsa.share_window, Duration());
  ASSERT_EQ(salsa.links.size(), 2u);
  const ServerLinkStatus& link = salsa.links[0];
  EXPECT_EQ(link.peer, "somewhere");
  EXPECT_NEAR(link.age.as_seconds(), 8.0, 0.2);
  EXPECT_LT(link.last_heard, Duration::ms(50));
  ASSERT_TRUE(link.round_trip);
  EXPECT_NEAR(link.round_trip->as_ms(), 10.0, 1.5);
  ASSERT_TRUE(link.loss_up);
  EXPECT_EQ(*link.loss_up, 0.0);
  EXPECT_FALSE(link.loss_down) << "nobody else dances: there is nothing to lose";
  ASSERT_EQ(link.guests.size(), 2u);
  EXPECT_EQ(link.guests[0].id, guest("alice"));
  EXPECT_NEAR(static_cast<double>(link.guests[0].poses), 8 * 1000.0 / Dance::kFrame_ms, 20.0);
  ASSERT_TRUE(link.guests[0].jitter);
  // Frames of 16 ms, and captures that are all as old: as even as ticks and mapped clocks let it.
  EXPECT_LT(link.guests[0].jitter->as_us(), 200.0);
  EXPECT_FALSE(link.guests[1].jitter) << "anna has not danced";
  EXPECT_TRUE(salsa.links[1].guests.empty());
  ASSERT_TRUE(salsa.links[1].loss_down);
  EXPECT_EQ(*salsa.links[1].loss_down, 0.0);
  EXPECT_EQ(now.rooms[1].name, guest("tango"));
}

TEST_F(StatusTest, CountsBytesAsTheyPass) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  std::map<PeerId, double> up, down;
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes bytes) {
    (to_server ? up : down)[peer] += static_cast<double>(bytes.size() + wire::kSealOverhead);
    return true;
  };
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 10);
  const ServerStatus now = status();
  ASSERT_EQ(now.rooms.size(), 1u);
  ASSERT_EQ(now.rooms[0].links.size(), 2u);
  const auto& links = now.rooms[0].links;
  // All but the hellos and welcomes at the begin, and what is under way at the end.
  constexpr double kEnds = 4 * 512;
  EXPECT_NEAR(static_cast<double>(links[0].bytes_in), up[a.peer], kEnds);
  EXPECT_NEAR(static_cast<double>(links[1].bytes_out), down[b.peer], kEnds);
  EXPECT_NEAR(links[0].bytes_in_per_s, static_cast<double>(links[0].bytes_in) / 10.0,
              0.1 * links[0].bytes_in_per_s);
  EXPECT_GT(links[0].datagrams_in_per_s, 1000.0 / Dance::kFrame_ms);
  EXPECT_NEAR(static_cast<double>(links[1].bytes_in), up[b.peer], kEnds);
  // Rates are of the last seconds.
  dance.dancers.clear();
  run(dance, 8);
  EXPECT_LT(status().rooms[0].links[0].bytes_in_per_s, 0.5 * links[0].bytes_in_per_s);
}

TEST_F(StatusTest, TellsOnWhichWayPosesAreLost) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  run(dance, 3);
  Random random(7);
  // One in five of alice's datagrams does not reach the server.
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes) {
    return !(to_server && peer == a.peer) || random.next_u64() % 5 != 0;
  };
  run(dance, 10);
  const auto links = status().rooms.at(0).links;
  ASSERT_TRUE(links[0].loss_up && links[1].loss_up && links[0].loss_down && links[1].loss_down);
  EXPECT_NEAR(*links[0].loss_up, 0.2, 0.08);
  EXPECT_LT(*links[1].loss_up, 0.01);
  EXPECT_NEAR(*links[1].loss_down, 0.2, 0.08) << "bob does not get what never came";
  EXPECT_LT(*links[0].loss_down, 0.01);
  EXPECT_GT(links[0].guests[0].lost, 50u);
  EXPECT_GT(links[1].poses_lost, 50u);
  // When the line is well again, so is the status.
  tunnel.on_datagram = nullptr;
  run(dance, 8);
  EXPECT_LT(*status().rooms.at(0).links.at(0).loss_up, 0.01);
}

TEST_F(StatusTest, AnUnevenWayIsJitter) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.add_house("salsa", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 2);
  Random random(11);
  tunnel.on_datagram = [&](bool to_server, PeerId peer, wire::Bytes) {
    if (to_server && peer == a.peer)
      a.up = Duration::ms(5 + static_cast<std::int64_t>(random.next_u64() % 21));
    return true;
  };
  run(dance, 5);
  // |X − Y| of two uniform ways of 0 to 20 ms has the mean 7 ms.
  EXPECT_NEAR(status().rooms.at(0).links.at(0).jitter->as_ms(), 7.0, 3.5);
}

TEST_F(StatusTest, WhoHasLeftIsGone) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  auto& b = tunnel.add_house("tango", {"bob"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 2);
  EXPECT_EQ(status().rooms.size(), 2u);
  b.link->send_goodbye();
  b.is_running = false;
  run(dance, 1);
  ASSERT_EQ(status().rooms.size(), 1u);
  EXPECT_EQ(status().rooms[0].name, guest("salsa"));
  EXPECT_EQ(to_json(status()).find("bob"), std::string::npos);
}

TEST_F(StatusTest, WhoSaidNoMoreThanHelloIsNotShown) {
  wire::Hello hello;
  hello.token = 7;
  hello.room = guest("salsa");
  ASSERT_TRUE(hello.codecs.try_push({CodecId::kPlain, 0}));
  ASSERT_TRUE(hello.guests.try_push(guest("mallory")));
  std::array<std::uint8_t, wire::kMaxHello> bytes;
  tunnel.inject(tunnel.add_peer(), {bytes.data(), wire::build(hello, bytes)});
  ASSERT_EQ(tunnel.server().session_count(), 1u);
  maker.sample(tunnel.now());
  EXPECT_TRUE(status().rooms.empty());
}

TEST_F(StatusTest, JsonHasEverythingAndNoSecret) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.add_house("salsa", {});
  handshakes = {{"unknown_key", 3}, {"done", 2}};
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 3);
  tunnel.inject(tunnel.add_peer(), std::vector<std::uint8_t>{});
  const std::string text = to_json(status());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  ASSERT_TRUE(json.is_object()) << text;
  EXPECT_EQ(json["address"], "127.0.0.1:7400");
  EXPECT_EQ(json["uptime_s"], 3.0);
  EXPECT_EQ(json["rejects"]["too_short"], 1);
  EXPECT_EQ(json["rejects"].size(), kServerRejects);
  EXPECT_EQ(json["handshakes"]["unknown_key"], 3);
  const auto& room = json["rooms"][0];
  EXPECT_EQ(room["name"], "salsa");
  EXPECT_EQ(room["share_window_ms"], 0.0);
  EXPECT_TRUE(room["links"][0]["budget_bytes_per_s"].is_null());
  EXPECT_EQ(room["links"][0]["thinned"], 0);
  const auto& link = room["links"][0];
  EXPECT_EQ(link["guests"][0]["name"], "alice");
  EXPECT_GT(link["guests"][0]["poses"], 100);
  EXPECT_TRUE(link["loss_down"].is_null());
  EXPECT_TRUE(room["links"][1]["jitter_ms"].is_null());
  for (const ServerSession& session : tunnel.server().sessions())
    if (session.in_use) {
      EXPECT_EQ(text.find(std::to_string(session.token)), std::string::npos);
    }
}

TEST_F(StatusTest, ReportsTheShownNameBesideTheId) {
  tunnel.link_options.channels = {*ChannelRule::parse("NAMES/* class=state layout=bytes[41]")};
  tunnel.link_options.channels[0].layout = *LayoutCheck::parse("any");
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::ms(300));
  const auto shown = [&](std::string_view name) {
    std::vector<std::uint8_t> bytes{0};
    bytes.insert(bytes.end(), name.begin(), name.end());
    a.link->send_channel("NAMES/alice", bytes, tunnel.time_in(a), guest("alice"));
    tunnel.run(Duration::s(1));
    const auto json = nlohmann::json::parse(to_json(status()), nullptr, false);
    EXPECT_TRUE(json.is_object());
    return json["rooms"][0]["links"][0]["guests"][0].value("shown_name", "");
  };
  EXPECT_EQ(shown("Alicia \"L\u00f3pez\" \\"), "Alicia \"L\u00f3pez\" \\");
  EXPECT_EQ(shown("A\x1b[2J"), "") << "an invalid name";
  EXPECT_EQ(shown(""), "");
}

TEST_F(StatusTest, JsonStaysJsonWhateverAPeerIsCalled) {
  tunnel.add_house("salsa", {"alice"});
  tunnel.run(Duration::s(1));
  ServerStatusMaker other(
      tunnel.server(), {}, "here",
      [](const ServerSession&) { return std::string("a\"b\\c\n\x80\0d", 9); }, tunnel.now());
  handshakes = {{"\"odd\"", UINT64_MAX}};
  const auto json =
      nlohmann::json::parse(to_json(other.make(tunnel.now(), handshakes)), nullptr, false);
  ASSERT_TRUE(json.is_object());
  EXPECT_EQ(json["rooms"][0]["links"][0]["peer"], "a?b?c???d");
  EXPECT_EQ(json["handshakes"]["?odd?"], UINT64_MAX);
  EXPECT_TRUE(nlohmann::json::parse(to_json(ServerStatus()), nullptr, false).is_object());
}

TEST_F(StatusTest, ShareWindowIsTheRoomsOrTheKeepers) {
  tunnel.add_house("crowd", {"g0", "g1", "g2", "g3", "g4", "g5", "g6", "g7", "g8", "g9"});
  Dance dance{tunnel, {}};
  run(dance, 1);
  EXPECT_EQ(status().rooms.at(0).share_window, Duration());
  ServerLimits limits;
  limits.share_window = Duration::ms(3);
  EXPECT_EQ(make_maker(limits).make(tunnel.now(), {}).rooms.at(0).share_window, Duration::ms(3));
}

TEST_F(StatusTest, SamplingAllocatesNothing) {
  auto& a = tunnel.add_house("salsa", {"alice"});
  Dance dance{tunnel, {{&a, guest("alice")}}};
  dance.run(Duration::s(1));
  const AllocationGuard guard;
  for (int i = 0; i < 40; ++i) maker.sample(tunnel.now() + Duration::s(i));
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST_F(StatusTest, MetricsNameWhoIsHereAndForgetWhoHasLeft) {
  auto& a = tunnel.add_house("salsa", {"alice", "anna"});
  auto& b = tunnel.add_house("salsa", {"bob"});
  tunnel.add_house("salsa", {});
  handshakes = {{"unknown_key", 3}};
  Dance dance{tunnel, {{&a, guest("alice")}, {&b, guest("bob")}}};
  run(dance, 3);
  const std::string text = metrics_text(status());
  if (text.empty()) GTEST_SKIP() << "built without Prometheus";
  for (const char* line :
       {"# TYPE dance_server_received_bytes_total counter\n", "\ndance_server_guests 3\n",
        "\ndance_server_links 3\n", "\ndance_server_room_listeners{room=\"salsa\"} 1\n",
        "\ndance_server_rejected_total{cause=\"malformed\"} 0\n",
        "\ndance_server_handshakes_total{cause=\"unknown_key\"} 3\n",
        "\ndance_server_link_loss_down_ratio{room=\"salsa\",guest=\"alice\"} 0\n",
        "\ndance_server_guest_poses_lost{room=\"salsa\",guest=\"bob\"} 0\n",
        "\ndance_server_guest_poses_total{room=\"salsa\",guest=\"anna\"} 0\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  EXPECT_EQ(text.find("guest_jitter_seconds{room=\"salsa\",guest=\"anna\"}"), std::string::npos)
      << "nothing is known of it";
  EXPECT_EQ(text.find("somewhere"), std::string::npos) << "addresses are not bounded";
  b.link->send_goodbye();
  b.is_running = false;
  run(dance, 1);
  EXPECT_EQ(metrics_text(status()).find("bob"), std::string::npos);
}

TEST_F(StatusTest, SortsKeysByUse) {
  const auto key = [](const char* name) { return Access{.name = guest(name)}; };
  auto& a = tunnel.add_house("salsa", {"alice"}, {}, key("alice"));
  tunnel.add_house("salsa", {"bob"}, {}, key("bob"));
  tunnel.add_house("tango", {"bob-2"}, {}, key("bob"));
  tunnel.add_house("tango", {"carol"}, {}, key("carol"));
  Dance dance{tunnel, {{&a, guest("alice")}}};
  run(dance, 8);
  const ServerStatus now = status();
  ASSERT_EQ(now.keys.size(), 3u);
  EXPECT_EQ(now.keys[0].sessions + now.keys[1].sessions + now.keys[2].sessions, 4u);
  for (std::size_t i = 1; i < now.keys.size(); ++i)
    EXPECT_GE(now.keys[i - 1].bytes_in_per_s + now.keys[i - 1].bytes_out_per_s,
              now.keys[i].bytes_in_per_s + now.keys[i].bytes_out_per_s);
  EXPECT_EQ(now.keys[2].name, "carol") << "hears of nobody's dance";
  const auto json = nlohmann::json::parse(to_json(now));
  for (const auto& of : json["keys"])
    if (of["name"] == "bob") {
      EXPECT_EQ(of["sessions"], 2);
      EXPECT_EQ(of["rooms"], 2);
    }
}

}  // namespace
}  // namespace dance
