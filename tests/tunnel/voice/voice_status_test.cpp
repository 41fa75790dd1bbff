// What a server tells of voices.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tunnel/voice/voices.h"
#include "tunnel/server/program/server_metrics.h"
#include "tunnel/server/program/server_status.h"

namespace dance {
namespace {

TEST(VoiceStatus, TellsWhoSpeaksAndWhatOfItWasSent) {
  SimulatedTunnel tunnel;
  auto& a = tunnel.add_house("salsa", {"alice"});
  tunnel.add_house("salsa", {"bob"});
  tunnel.add_house("salsa", {});
  ServerStatusMaker maker(
      tunnel.server(), {}, "127.0.0.1:7400",
      [](const ServerSession&) { return std::string("somewhere"); }, tunnel.now());
  tunnel.run(Duration::ms(200));
  maker.sample(tunnel.now());
  Talk talk{tunnel, {{&a, guest("alice")}}};
  talk.run(Duration::s(2));
  tunnel.run(Duration::ms(20));
  const ServerStatus status = maker.make(tunnel.now(), {});
  const auto json = nlohmann::json::parse(to_json(status), nullptr, false);
  ASSERT_TRUE(json.is_object());
  const auto& links = json["rooms"][0]["links"];
  EXPECT_EQ(links[0]["guests"][0]["voices"], 200);
  EXPECT_EQ(links[0]["guests"][0]["voice_bytes"], 200 * 40);
  EXPECT_NEAR(links[0]["voices_in_per_s"].get<double>(), 100.0, 2.0);
  EXPECT_EQ(links[0]["voices_out_per_s"], 0.0);
  EXPECT_NEAR(links[1]["voices_out_per_s"].get<double>(), 100.0, 2.0);
  EXPECT_EQ(json["totals"]["voices_in"], 200);
  EXPECT_EQ(json["totals"]["voices_out"], 400);
  EXPECT_EQ(json["totals"]["voice_bytes_out"], 400 * (40 + 12 + 1 + 26));
  EXPECT_EQ(json["totals"]["voices_crowded"], 0);
  const std::string text = metrics_text(status);
  if (text.empty()) GTEST_SKIP() << "built without Prometheus";
  for (const char* line :
       {"\ndance_server_voices_received_total 200\n", "\ndance_server_voices_sent_total 400\n",
        "\ndance_server_voices_left_out_total{cause=\"crowded\"} 0\n",
        "\ndance_server_guest_voices_total{room=\"salsa\",guest=\"alice\"} 200\n",
        "\ndance_server_guest_voice_bytes_total{room=\"salsa\",guest=\"alice\"} 8000\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

}  // namespace
}  // namespace dance
