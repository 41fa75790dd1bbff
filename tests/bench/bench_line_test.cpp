// The bench of lines as a user runs it: what it says must hang together, whatever the machine's
// speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

// 6 Mbit/s for 400 ms, then nothing for 300 ms.
void write_capacity_trace(const std::string& path) {
  std::ofstream file(path);
  for (int ms = 0; ms < 400; ms += 2) file << ms << '\n';
  file << "700\n";
}

void expect_ordered(const nlohmann::json& ages) {
  EXPECT_GT(ages["p50"].get<double>(), 0.0);
  EXPECT_LE(ages["p50"].get<double>(), ages["p95"].get<double>());
  EXPECT_LE(ages["p95"].get<double>(), ages["p99"].get<double>());
  EXPECT_LE(ages["p99"].get<double>(), ages["max"].get<double>());
}

void expect_a_way(const nlohmann::json& way) {
  EXPECT_GT(way["sent"].get<int>(), 0);
  EXPECT_GT(way["delivered"].get<int>(), 0);
  EXPECT_LE(way["delivered"].get<int>(), way["sent"].get<int>());
  EXPECT_GE(way["first_ms"].get<double>(), 0.0);
  expect_ordered(way["age_ms"]);
  expect_ordered(way["stage_age_ms"]);
  EXPECT_GT(way["stage_moments"].get<int>(), 0);
  EXPECT_GE(way["frozen_s"].get<double>(), 0.1 * way["freezes"].get<int>());
  EXPECT_LE(way["worst_gap_to_pose_ms"].get<double>(), way["worst_gap_ms"].get<double>());
  EXPECT_EQ(way["older_delivered"], 0);
  EXPECT_EQ(way["older_shown"], 0);
  const auto& line = way["line"];
  EXPECT_GE(line["offered"].get<int>(), way["delivered"].get<int>());
  EXPECT_LE(line["delivered"].get<int>() + line["lost"].get<int>() +
                line["queue_dropped"].get<int>() + line["overflow"].get<int>(),
            line["offered"].get<int>());
}

TEST(BenchLineProgram, MeasuresACleanLineAndARecordedOne) {
  const TestFolder folder("bench-line");
  const std::string up = folder.path("stops.up"), down = folder.path("stops.down");
  write_capacity_trace(up);
  write_capacity_trace(down);
  const Finished done = run(bin("dance-bench-line") + " " + up + "," + down +
                            " --link 'delay=5ms queue=100ms' --seconds 2 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk << done.output;
  const auto report = nlohmann::json::parse(done.output);
  EXPECT_EQ(report["seconds"], 2.0);
  ASSERT_EQ(report["lines"].size(), 2u);
  EXPECT_EQ(report["lines"][0]["name"], "clean");
  EXPECT_EQ(report["lines"][1]["name"], "stops");
  for (const auto& line : report["lines"]) {
    expect_a_way(line["up"]);
    expect_a_way(line["down"]);
    EXPECT_TRUE(line["has_converged"].get<bool>());
    EXPECT_GT(line["round_trip_ms"].get<double>(), 0.0);
  }
  EXPECT_GE(report["lines"][1]["down"]["age_ms"]["p50"].get<double>(), 5.0);
  EXPECT_EQ(report["lines"][0]["up"]["line"]["queue_dropped"], 0);
}

TEST(BenchLineProgram, WritesATableForEachLineAndEachOfItsStarts) {
  const TestFolder folder("bench-line");
  const std::string trace = folder.path("wifi.csv");
  std::ofstream(trace) << "t_ms,owd_var_ms\n0,1\n100,30\n200,2\n";
  const Finished done =
      run(bin("dance-bench-line") + " " + trace +
          " --offset 0 --offset 1.5 --at-once 2 --seconds 0.5 --hz 100 --markdown");
  ASSERT_EQ(done.exit_code, 0) << done.talk << done.output;
  EXPECT_EQ(std::count(done.output.begin(), done.output.end(), '\n'), 2 + 3 * 2 + 2);
  for (const char* part : {"| clean | up |", "| wifi | down |", "| wifi @1.5s | up |"})
    EXPECT_NE(done.output.find(part), std::string::npos) << done.output;
}

TEST(BenchLineProgram, NamesATraceThatIsNoTraceAndTheCure) {
  const TestFolder folder("bench-line");
  const std::string trace = folder.path("prose.txt");
  std::ofstream(trace) << "once upon a time\n";
  const Finished done = run(bin("dance-bench-line") + " " + trace + " --seconds 0.5");
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_NE(done.talk.find("prose.txt', line 1: a trace begins with"), std::string::npos)
      << done.talk;
  const Finished wrong = run(bin("dance-bench-line") + " --link 'delay=3' --seconds 0.5");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.talk.find("'delay=3'"), std::string::npos) << wrong.talk;
}

}  // namespace
}  // namespace dance
