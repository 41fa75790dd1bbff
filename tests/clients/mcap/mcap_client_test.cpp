// A living couple recorded by dance-listen as MCAP, read by @mcap/core.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/program/child_process.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

const std::string kModules = DANCE_SOURCE_DIR "/build/clients/node_modules";
const std::string kReader = DANCE_SOURCE_DIR "/tests/clients/mcap/read_mcap.js";

std::string seconds() {
  const char* given = std::getenv("DANCE_CLIENT_SECONDS");
  return given ? given : "15";
}

std::string why_not() {
  if (run("node --version").exit_code != 0) return "node is missing; apt-get install npm";
  for (const char* module : {"@mcap/core", "ajv", "fzstd", "@foxglove/schemas"})
    if (!std::filesystem::exists(kModules + "/" + module))
      return std::string(module) + " is missing; tests/clients/fetch_clients.sh fetches it";
  return "";
}

class McapClient : public BusPrograms {
 protected:
  void SetUp() override {
    if (const std::string why = why_not(); !why.empty()) GTEST_SKIP() << why;
    open_house();
  }
  nlohmann::json read_with_client(const std::string& mcap, const std::string& csv) {
    const Finished read =
        run("NODE_PATH=" + kModules + " node " + kReader + " " + mcap + " " + csv);
    EXPECT_EQ(read.exit_code, 0) << read.talk;
    return nlohmann::json::parse(read.output, nullptr, false);
  }
};

TEST_F(McapClient, ReadsALivingCoupleWithEveryChecksumAndSchemaAndAllJointsInTheirPlaces) {
  const std::string mcap = folder_.path("night.mcap"), csv = folder_.path("night.csv");
  const std::string listen = bin("dance-listen") + " --bus " + quoted(kBus);
  // The table begins earlier and ends later, so that it has every pose of the recording.
  ChildProcess& table = start("dance-listen", {"--bus", kBus, "--to", "csv", "-o", csv});
  std::error_code unknown;
  ASSERT_TRUE(wait_for([&] {
    const auto size = std::filesystem::file_size(csv, unknown);
    return !unknown && size > 100'000;
  }));
  const Finished heard = run(listen + " --to mcap -o " + mcap + " --seconds " + seconds());
  ASSERT_EQ(heard.exit_code, 0) << heard.talk;
  table.stop(Duration::s(10));

  const nlohmann::json report = read_with_client(mcap, csv);
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["problems"], nlohmann::json::array());
  EXPECT_EQ(report["invalid"], 0) << report.dump(1);
  EXPECT_EQ(report["out_of_order"], 0);
  EXPECT_EQ(report["indexed_messages"], report["messages"]);
  EXPECT_EQ(report["guests"].size(), 2u) << report.dump(1);
  const double expected = 2.0 * std::stod(seconds()) * 5.0;  // of 60 a second
  EXPECT_GT(report["compared"].get<double>(), expected) << report.dump(1);
  EXPECT_EQ(report["compared"].get<int>(),
            report["guests"]["alice"].get<int>() + report["guests"]["bob"].get<int>());
  EXPECT_LT(report["largest_difference_mm"].get<double>(), 0.1) << report.dump(1);
  EXPECT_TRUE(report["upright"].get<bool>());
  EXPECT_EQ(report["drawn_entities"], 45);  // 22 bones of each, and the floor
  EXPECT_EQ(report["entities_without_frame"], 0);
}

TEST_F(McapClient, KeepsWhatAKilledRecorderHadWritten) {
  const std::string mcap = folder_.path("killed.mcap");
  ChildProcess& recorder = start("dance-listen", {"--bus", kBus, "--to", "mcap", "-o", mcap});
  std::error_code unknown;
  ASSERT_TRUE(wait_for([&] {
    const auto size = std::filesystem::file_size(mcap, unknown);
    return !unknown && size > 400'000;
  }));
  ASSERT_TRUE(recorder.send_signal(SIGKILL));
  const Finished converted =
      run(bin("dance-convert") + " " + mcap + " " + folder_.path("killed.lcm") + " --json");
  EXPECT_EQ(converted.exit_code, 0) << converted.talk;
  EXPECT_NE(converted.talk.find("stopped before the end"), std::string::npos) << converted.talk;
  const nlohmann::json report = nlohmann::json::parse(converted.output, nullptr, false);
  EXPECT_EQ(report["guests"], 2) << converted.output;
  EXPECT_GT(report["frames"].get<int>(), 60) << converted.output;
}

}  // namespace
}  // namespace dance
