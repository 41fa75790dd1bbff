// The demo as a user starts it: real programs, two buses, a server, in a network of this test's own.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/tools/run_program.h"

namespace {

namespace fs = std::filesystem;
using dance::bin;
using dance::Finished;
using dance::TestFolder;

nlohmann::json run_demo(const std::string& options, const std::string& out) {
  const Finished demo =
      dance::run(bin("dance-demo") + " --headless --json --out " + out + " " + options);
  auto json = nlohmann::json::parse(demo.output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << demo.output << demo.talk;
  return json;
}

// How many poses are sent, and how many of them a program that had to wait found overtaken by newer ones, depends on
// how busy the machine is. Each one is accounted for, and most arrive; docs/latency.md has the command that measures.
void expect_all_delivered(const nlohmann::json& summary, std::size_t guests) {
  ASSERT_EQ(summary["guests"].size(), guests);
  for (const auto& guest : summary["guests"]) {
    const auto sent = guest["sent"].get<std::int64_t>();
    const auto delivered = guest["delivered"].get<std::int64_t>();
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_GE(sent, 60) << guest;
    EXPECT_EQ(delivered + lost, sent) << guest;
    EXPECT_GE(2 * delivered, sent) << guest;
  }
}

// The pid of a child of the demo that was started with this word in its command line.
pid_t find_program(const std::string& word, const std::string& session) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "cmdline");
    std::stringstream line;
    line << file.rdbuf();
    if (line.str().find(word) != std::string::npos && line.str().find(session) != std::string::npos)
      return static_cast<pid_t>(std::stol(entry.path().filename().string()));
  }
  return 0;
}

TEST(Demo, DeliversACoupleBothWaysOnACleanLine) {
  const TestFolder folder("clean");
  const std::string out = folder.path();
  const auto summary = run_demo("--seconds 4", out);
  expect_all_delivered(summary, 2);
  EXPECT_TRUE(fs::exists(summary["log"].get<std::string>()));
}

TEST(Demo, KeepsThirtyDancersWholeAndInStep) {
#ifdef DANCE_SANITIZED
  GTEST_SKIP() << "thirty dancers are too many for two cores under a sanitizer";
#endif
  const TestFolder folder("crowd");
  const auto summary = run_demo("--guests 30 --seconds 4", folder.path());
  expect_all_delivered(summary, 30);
  // In step: whoever dances in one house is staged at the same ticks of the other.
  std::map<std::string, std::int64_t> most;
  for (const auto& guest : summary["guests"]) {
    auto& count = most[guest["house"].get<std::string>()];
    count = std::max(count, guest["staged"].get<std::int64_t>());
  }
  for (const auto& guest : summary["guests"])
    EXPECT_GE(guest["staged"].get<double>(),
              0.9 * static_cast<double>(most[guest["house"].get<std::string>()]))
        << guest;
}

TEST(Demo, AccountsForEveryPoseOfABadLine) {
  const TestFolder folder("line");
  const std::string out = folder.path();
  const auto summary = run_demo("--seconds 4 --link 'delay=40ms jitter=5ms loss=5% seed=3'", out);
  ASSERT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) {
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_EQ(guest["sent"].get<std::int64_t>(), guest["delivered"].get<std::int64_t>() + lost)
        << guest;
    EXPECT_GT(lost, 0) << guest;
    EXPECT_GT(guest["age_p50_ms"].get<double>(), 40.0) << guest;
  }
}

TEST(Demo, GoesOnWhenAnyOfItsProgramsIsKilledAndItComesBack) {
  const TestFolder folder("kill");
  const std::string out = folder.path();
  nlohmann::json summary;
  std::thread demo([&] { summary = run_demo("--seconds 14", out); });
  const auto kill_after = [&](int ms, const std::string& word, const std::string& mark) {
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    const pid_t pid = find_program(word, mark);
    EXPECT_GT(pid, 0) << word;
    if (pid > 0) kill(pid, SIGKILL);
  };
  kill_after(4000, "dance-join", out + "/programs/house-b.toml");
  kill_after(2500, "dance-server", "--port");
  kill_after(2500, "dance-record", out + "/demo.lcm");
  const auto recorded = fs::file_size(out + "/demo.lcm");
  kill_after(1000, "dance-salsa", "alice");
  demo.join();
  ASSERT_TRUE(summary.is_object());
  EXPECT_GE(summary["restarts"].get<int>(), 4);
  for (const auto& guest : summary["guests"]) {
    EXPECT_GE(guest["sent"].get<int>(), 420) << "the others go on: " << guest;
    // Away for half a second each, and back soon.
    EXPECT_GE(guest["delivered"].get<double>(), 0.4 * guest["sent"].get<double>()) << guest;
  }
  EXPECT_GT(fs::file_size(out + "/demo.lcm"), recorded) << "the log goes on";
}

TEST(Demo, LeavesAloneWhatIsNotItsOwn) {
  const TestFolder folder("pictures");
  for (const char* name : {"holiday.png", "stage-door.png", "alice.json"})
    std::ofstream(folder.path(name)) << "mine";
  const auto summary = run_demo("--seconds 1", folder.path());
  for (const char* name : {"holiday.png", "stage-door.png", "alice.json"})
    EXPECT_EQ(dance::text_of(folder.path(name)), "mine") << name;
  for (const auto& picture : summary["pictures"])
    EXPECT_EQ(picture.get<std::string>().find("holiday"), std::string::npos);
}

TEST(Demo, RefusesWhatCannotBeInOneLine) {
  for (const auto& [options, word] :
       {std::pair<std::string, std::string>{"--motion /nonexistent.bvh", "nonexistent.bvh"},
        {"--guests 1", "guests"},
        {"--through fly", "fly"},
        {"--nonsense", "nonsense"}}) {
    const TestFolder folder("wrong");
    const Finished demo = dance::run(bin("dance-demo") + " --headless --seconds 1 --out " +
                                     folder.path() + " " + options);
    EXPECT_NE(demo.exit_code, 0) << options;
    EXPECT_NE(demo.talk.find(word), std::string::npos) << options << ": " << demo.talk;
  }
}

}  // namespace
