// The bench of the tunnel as a user runs it: it must measure what it says, whatever the machine's
// speed.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

void expect_a_way(const nlohmann::json& way) {
  EXPECT_GT(way["sent"].get<int>(), 0);
  EXPECT_GT(way["delivered"].get<int>(), 0);
  EXPECT_LE(way["delivered"].get<int>(), way["sent"].get<int>());
  EXPECT_GT(way["p50_us"].get<double>(), 0.0);
  EXPECT_LE(way["p50_us"].get<double>(), way["p99_us"].get<double>());
  EXPECT_LE(way["p99_us"].get<double>(), way["max_us"].get<double>());
  EXPECT_GT(way["bytes_per_second_down_per_guest"].get<double>(), 0.0);
  // The headers of IP and UDP at least, but for what shares a datagram on the way down.
  EXPECT_GE(way["overhead_bytes_per_pose_up"].get<double>(), 28.0);
  EXPECT_GT(way["overhead_bytes_per_pose_down"].get<double>(), 28.0 / 3);
}

TEST(BenchTunnel, MeasuresTheTunnelBesideOtherRelays) {
  const Finished done = run(bin("dance-bench-tunnel") + " --guests 4 --seconds 0.5 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto report = nlohmann::json::parse(done.output);
  EXPECT_EQ(report["guests"], 4);
  expect_a_way(report);
  expect_a_way(report["baseline_raw_udp"]);
  if (report.contains("baseline_enet")) expect_a_way(report["baseline_enet"]);
  expect_a_way(report["spread"]);
  expect_a_way(report["spread"]["baseline_raw_udp"]);
  // The same dance in both; where a machine drops what it has no time for, of both.
  const auto bytes_a_pose = [](const nlohmann::json& way) {
    return way["bytes_per_second_down_per_guest"].get<double>() / way["delivered"].get<double>();
  };
  EXPECT_LT(bytes_a_pose(report), bytes_a_pose(report["baseline_raw_udp"]));
}

TEST(BenchTunnel, RefusesACrowdOfOne) {
  const Finished done = run(bin("dance-bench-tunnel") + " --guests 1");
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_NE(done.talk.find("--guests"), std::string::npos) << done.talk;
}

TEST(BenchAvatar, BringsFilesThroughTheTunnelBesideThePoses) {
  const Finished done =
      run(bin("dance-bench-avatar") + " --mb 0.05 --rate 200000 --rounds 2 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto report = nlohmann::json::parse(done.output);
  EXPECT_GT(report["seconds"].get<double>(), 0.0);
  for (const char* way : {"with", "without"}) {
    EXPECT_GT(report[way]["sent"].get<int>(), 0) << way;
    EXPECT_GT(report[way]["delivered"].get<int>(), 0) << way;
  }
}

}  // namespace
}  // namespace dance
