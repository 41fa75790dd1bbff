// The bench of play-out buffers as a user runs it; simulated time, so the same everywhere.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/run_program.h"

namespace dance {
namespace {

TEST(BenchHold, ShowsThatNoFixedTimeSuitsEveryLine) {
  const std::string bench = bin("dance-bench-hold") + " --json --seconds 30 ";
  const std::string calm_line = "delay=40ms", bad_line = "delay=40ms jitter=40ms loss=3%";
  const Finished calm = run(bench + "--link '" + calm_line + "'");
  const Finished bad = run(bench + "--link '" + bad_line + "'");
  ASSERT_EQ(calm.exit_code, 0) << calm.talk;
  ASSERT_EQ(bad.exit_code, 0) << bad.talk;
  const auto on_calm = nlohmann::json::parse(calm.output)[calm_line];
  const auto on_bad = nlohmann::json::parse(bad.output)[bad_line];
  EXPECT_LT(on_calm["hold"]["added_p50_ms"], 18.0);
  EXPECT_LT(on_calm["hold"]["late_percent"], 0.5);
  EXPECT_GT(on_bad["hold 20ms"]["late_percent"], 20.0);
  EXPECT_LT(on_bad["hold"]["late_percent"], 5.0);
  EXPECT_LT(on_bad["hold"]["added_p50_ms"], 100.0);
}

TEST(BenchHold, NamesATransformerThatThereIsNot) {
  const Finished done = run(bin("dance-bench-hold") + " --through 'hodl 3ms'");
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_NE(done.talk.find("hodl"), std::string::npos) << done.talk;
}

TEST(BenchHold, NamesATraceThatIsNotThere) {
  const Finished done = run(bin("dance-bench-hold") + " no-such-trace.csv");
  EXPECT_NE(done.exit_code, 0);
  EXPECT_NE(done.talk.find("no-such-trace.csv"), std::string::npos) << done.talk;
}

}  // namespace
}  // namespace dance
