// The load generator as a user runs it, against a real server.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/net/udp_socket.h"
#include "core/program/child_process.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

class CrowdPrograms : public ::testing::Test {
 protected:
  ChildProcess start(const std::string& program, const std::vector<std::string>& arguments) {
    auto child = ChildProcess::start(
        {bin(program), arguments, folder_.path("output"), folder_.path("talk")});
    EXPECT_TRUE(child) << child.error().what;
    return std::move(*child);
  }
  ChildProcess start_server(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--port", std::to_string(port_)});
    return start("dance-server", more);
  }
  std::string server() const { return "127.0.0.1:" + std::to_string(port_); }
  // Of all lines that were written so far; half a line is none.
  static std::vector<nlohmann::json> lines_of(const std::string& output) {
    std::vector<nlohmann::json> lines;
    std::istringstream in(output);
    for (std::string line; std::getline(in, line);) {
      auto json = nlohmann::json::parse(line, nullptr, false);
      if (json.is_object()) lines.push_back(std::move(json));
    }
    return lines;
  }
  std::uint64_t sum_of(const char* count) const {
    std::uint64_t sum = 0;
    for (const auto& line : lines_of(text_of(folder_.path("output"))))
      if (line.contains("second")) sum += line[count].get<std::uint64_t>();
    return sum;
  }

  TestFolder folder_{"crowd"};
  std::uint16_t port_ = free_loopback_port().value_or(7499);
};

TEST_F(CrowdPrograms, MeasuresWhatEachGuestHearsOfTheOthers) {
  const Finished done = run(bin("dance-crowd") +
                            " --guests 10 --rooms 2 --threads 2 --decode 2 --join-rate 100 "
                            "--seconds 2 --json");
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto lines = lines_of(done.output);
  ASSERT_GE(lines.size(), 3u) << done.output;
  const auto& sum = lines.back();
  EXPECT_TRUE(sum["summary"].get<bool>());
  EXPECT_EQ(sum["present"], 10);
  EXPECT_EQ(sum["seconds"], 2);
  EXPECT_GT(sum["sent"].get<int>(), 0);
  // Each pose is for the four others of its room; at most a second's are under way at an end.
  EXPECT_GT(sum["delivered"].get<int>(), 0);
  EXPECT_LE(sum["delivered"].get<int>(), 4 * sum["sent"].get<int>() + 2 * 4 * 10 * 30);
  EXPECT_LE(sum["near_share"].get<double>(), 1.0);
  EXPECT_EQ(sum["far_share"], 1.0) << "in a room of five all others are near";
  EXPECT_GT(sum["p50_us"].get<double>(), 0.0);
  EXPECT_LE(sum["p50_us"].get<double>(), sum["p90_us"].get<double>());
  EXPECT_LE(sum["p90_us"].get<double>(), sum["p99_us"].get<double>());
  EXPECT_LE(sum["p99_us"].get<double>(), sum["worst_us"].get<double>());
  EXPECT_GT(sum["bytes_per_s_down_per_guest"].get<double>(),
            sum["bytes_per_s_up_per_guest"].get<double>());
  EXPECT_GT(sum["server_us_per_delivered_pose"].get<double>(), 0.0);
  EXPECT_EQ(sum["lapses"], 0);
  // What it counts is what the lines say, second by second.
  std::uint64_t sent = 0, delivered = 0;
  for (const auto& line : lines)
    if (line.value("measured", false)) {
      sent += line["sent"].get<std::uint64_t>();
      delivered += line["delivered"].get<std::uint64_t>();
    }
  EXPECT_EQ(sum["sent"].get<std::uint64_t>(), sent);
  EXPECT_EQ(sum["delivered"].get<std::uint64_t>(), delivered);
}

TEST_F(CrowdPrograms, ThinsWhatGuestsDoNotWant) {
  const Finished done = run(bin("dance-crowd") +
                            " --guests 3 --join-rate 100 --seconds 2 --json --want default=0 "
                            "--want guest-1=1");
  // Only guest 1 is heard, by the two others: of all poses two thirds, not twice as many.
  ASSERT_EQ(done.exit_code, 0) << done.talk;
  const auto sum = lines_of(done.output).back();
  EXPECT_LT(sum["delivered"].get<int>(), sum["sent"].get<int>() * 4 / 3);
  const Finished none =
      run(bin("dance-crowd") + " --guests 3 --join-rate 100 --seconds 1 --want default=0");
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.talk.find("nothing was delivered"), std::string::npos) << none.talk;
}

TEST_F(CrowdPrograms, SaysWhyGuestsAreNotIn) {
  const Finished silent =
      run(bin("dance-crowd") + " --guests 2 --wait 5 --join-rate 100 --server " + server());
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_NE(silent.talk.find(server() + " does not answer"), std::string::npos) << silent.talk;
  EXPECT_EQ(silent.talk.find("Trying on"), std::string::npos) << silent.talk;
  const ChildProcess running = start_server({"--max-guests", "3"});
  const Finished full =
      run(bin("dance-crowd") + " --guests 5 --wait 5 --join-rate 100 --server " + server());
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.talk.find("2 of 5 guests are not in: room 'crowd' is full"), std::string::npos)
      << full.talk;
}

TEST_F(CrowdPrograms, SaysWhatDoesNotFitThisMachine) {
  const Finished files = run("(ulimit -n 80; " + bin("dance-crowd") + " --guests 30)");
  EXPECT_EQ(files.exit_code, 1);
  EXPECT_NE(files.talk.find("30 guests need 124 open files, and this process may have 80"),
            std::string::npos)
      << files.talk;
  EXPECT_EQ(run(bin("dance-crowd") + " --guests 30 --rooms 31").exit_code, 2);
  EXPECT_EQ(run(bin("dance-crowd") + " --share-ms 1 --server " + server()).exit_code, 2);
  const Finished process = run(bin("dance-crowd") + " --cpu-of 0");
  EXPECT_EQ(process.exit_code, 1);
  EXPECT_NE(process.talk.find("--cpu-of 0"), std::string::npos) << process.talk;
}

TEST_F(CrowdPrograms, GoesOnThroughAServersDeathAndEndsBySignal) {
  auto running = std::make_unique<ChildProcess>(start_server());
  ChildProcess crowd = start("dance-crowd", {"--guests", "4", "--join-rate", "100", "--seconds",
                                             "0", "--churn", "1", "--json", "--server", server()});
  ASSERT_TRUE(wait_for([&] { return sum_of("left") > 0 && sum_of("delivered") > 0; }))
      << text_of(folder_.path("talk"));
  running->kill_now();
  ASSERT_TRUE(wait_for([&] { return sum_of("lapses") > 0; }));
  running = std::make_unique<ChildProcess>(start_server());
  ASSERT_TRUE(wait_for([&] { return sum_of("reconnects") > 0; }));
  crowd.stop(Duration::s(10));
  EXPECT_EQ(crowd.exit_code(), 0) << crowd.exit_text() << text_of(folder_.path("talk"));
  const auto lines = lines_of(text_of(folder_.path("output")));
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.back().contains("summary"));
}

}  // namespace
}  // namespace dance
