// The bench of replay as a user runs it, on a short night.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

TEST(BenchReplay, MakesANightAndJumpsToWhatReadingShows) {
  const Finished done = run(bin("dance-bench-replay") +
                            " --guests 3 --minutes 0.7 --arriving --seeks 25 --opens 2 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto report = nlohmann::json::parse(done.output);
  EXPECT_EQ(report["guests"], 3);
  EXPECT_NEAR(report["minutes"].get<double>(), 0.7, 0.05);
  EXPECT_EQ(report["seeks"], 25);
  EXPECT_EQ(report["different_scenes"], 0);
  for (const char* key : {"open_first_ms", "index_ms", "open_ms", "seek_ms_p50", "seek_ms_p99",
                          "baseline_reading_ms_p50"})
    EXPECT_GT(report[key].get<double>(), 0.0) << key;
}

TEST(BenchReplay, TakesALogOfYoursAndLeavesItsIndexBesideIt) {
  const TestFolder folder("bench-replay");
  const std::string log = folder.path("couple.lcm");
  std::filesystem::copy_file(std::string(DANCE_SOURCE_DIR) + "/logs/couple.lcm", log);
  const Finished done = run(bin("dance-bench-replay") + " --log " + log + " --seeks 10 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto report = nlohmann::json::parse(done.output);
  EXPECT_EQ(report["log_bytes"], std::filesystem::file_size(log));
  EXPECT_EQ(report["different_scenes"], 0);
  EXPECT_FALSE(report.contains("made_s"));
  EXPECT_TRUE(std::filesystem::exists(log + ".index"));
}

TEST(BenchReplay, NamesALogThatIsNotThere) {
  const Finished done = run(bin("dance-bench-replay") + " --log no-such.lcm");
  EXPECT_NE(done.exit_code, 0);
  EXPECT_NE(done.talk.find("no-such.lcm"), std::string::npos) << done.talk;
}

}  // namespace
}  // namespace dance
