// The demo as a user starts it: real programs, two buses, a server, in a network of this test's own.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/bus/log_file.h"
#include "tests/tools/run_program.h"

namespace {

namespace fs = std::filesystem;
using dance::bin;
using dance::Finished;
using dance::TestFolder;
using dance::wait_for;

nlohmann::json run_demo(const std::string& options, const std::string& out) {
  const Finished demo =
      dance::run(bin("dance-demo") + " --headless --json --out " + out + " " + options);
  auto json = nlohmann::json::parse(demo.output, nullptr, false);
  EXPECT_TRUE(json.is_object()) << demo.output << demo.talk;
  return json;
}

// How many poses are sent, and how many of them a program that had to wait found overtaken by newer ones, depends on
// how busy the machine is. Each one is accounted for, and dancers arrive; docs/latency.md has the command that measures.
void expect_all_delivered(const nlohmann::json& summary, std::size_t guests) {
  ASSERT_EQ(summary["guests"].size(), guests);
  for (const auto& guest : summary["guests"]) {
    const auto sent = guest["sent"].get<std::int64_t>();
    const auto delivered = guest["delivered"].get<std::int64_t>();
    std::int64_t lost = 0;
    for (const auto& [cause, count] : guest["lost"].items()) lost += count.get<std::int64_t>();
    EXPECT_GT(sent, 0) << guest;
    EXPECT_EQ(delivered + lost, sent) << guest;
    EXPECT_GE(10 * delivered, sent) << guest;
  }
}

std::string command_line_of(pid_t pid) {
  std::string line = dance::text_of("/proc/" + std::to_string(pid) + "/cmdline");
  std::replace(line.begin(), line.end(), '\0', ' ');
  return line;
}

pid_t parent_of(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("PPid:")) return static_cast<pid_t>(std::strtol(&line[5], nullptr, 10));
  return 0;
}

// A demo of this test's own, which ends with it; its programs are its children, whatever else runs on this machine.
class RunningDemo {
 public:
  RunningDemo(const std::string& options, const std::string& out)
      : out_(out), thread_([this, options] { summary_ = run_demo(options, out_); }) {}
  ~RunningDemo() { end(); }
  RunningDemo(const RunningDemo&) = delete;
  RunningDemo& operator=(const RunningDemo&) = delete;

  // Of the program with both of these in its command line; 0 where none runs.
  pid_t pid_of(const std::string& program, const std::string& mark) const {
    return find([&](pid_t pid, const std::string& line) {
      return line.find(program) != std::string::npos && line.find(mark) != std::string::npos &&
             is_demo(command_line_of(parent_of(pid)));
    });
  }
  // Asks it to end, if it has not; then its summary.
  const nlohmann::json& end() {
    if (!thread_.joinable()) return summary_;
    const pid_t demo = find([&](pid_t, const std::string& line) { return is_demo(line); });
    if (demo > 0) kill(demo, SIGTERM);
    thread_.join();
    return summary_;
  }

 private:
  template <class Wanted>
  static pid_t find(const Wanted& is_wanted) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc", error)) {
      const auto pid =
          static_cast<pid_t>(std::strtol(entry.path().filename().c_str(), nullptr, 10));
      if (pid > 0 && is_wanted(pid, command_line_of(pid))) return pid;
    }
    return 0;
  }
  bool is_demo(const std::string& line) const {
    return line.starts_with(bin("dance-demo") + " ") &&
           line.find(" " + out_ + " ") != std::string::npos;
  }

  std::string out_;
  nlohmann::json summary_;
  std::thread thread_;
};

int count_in_log(const std::string& path, const std::string& channel) {
  auto log = dance::LogReader::open(path);
  int count = 0;
  while (log) {
    const auto event = log->next();
    if (!event) break;
    count += event->channel.starts_with(channel) ? 1 : 0;
  }
  return count;
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
  // In step: whoever dances in one house is staged at the same ticks of the other, so that for each pose of theirs that
  // came it is about as many; one whose program came up late has fewer of both.
  std::map<std::string, std::vector<double>> ticks_of_house;
  const auto ticks_a_pose = [](const nlohmann::json& guest) {
    return guest["staged"].get<double>() / std::max(1.0, guest["delivered"].get<double>());
  };
  for (const auto& guest : summary["guests"])
    ticks_of_house[guest["house"].get<std::string>()].push_back(ticks_a_pose(guest));
  for (const auto& guest : summary["guests"]) {
    auto& ticks = ticks_of_house[guest["house"].get<std::string>()];
    std::sort(ticks.begin(), ticks.end());
    EXPECT_GT(guest["staged"].get<std::int64_t>(), 0) << guest;
    EXPECT_GE(ticks_a_pose(guest), 0.5 * ticks[ticks.size() / 2]) << guest;
  }
}

TEST(Demo, AccountsForEveryPoseOfABadLine) {
  const TestFolder folder("line");
  const std::string out = folder.path();
  const std::string trace = folder.path("capacity");
  std::ofstream capacity(trace);
  for (int ms = 0; ms < 1000; ms += 2) capacity << ms << '\n';
  capacity << "1100\n" << std::flush;
  const auto summary = run_demo(
      "--seconds 4 --link 'delay=40ms jitter=5ms loss=5% seed=3' --trace-up " + trace, out);
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

TEST(Demo, NamesATraceThatIsNotThereBeforeAnythingStarts) {
  const TestFolder folder("no-trace");
  const Finished demo = dance::run(bin("dance-demo") + " --headless --out " + folder.path() +
                                   " --trace-down /no/such.trace");
  EXPECT_EQ(demo.exit_code, 1);
  EXPECT_NE(demo.talk.find("'/no/such.trace' cannot be read"), std::string::npos) << demo.talk;
  EXPECT_FALSE(fs::exists(folder.path("demo.lcm")));
}

TEST(Demo, GoesOnWhenAnyOfItsProgramsIsKilledAndItComesBack) {
  const TestFolder folder("kill");
  const std::string out = folder.path(), log = out + "/demo.lcm";
  RunningDemo demo("--seconds 250", out);  // ended when all has been seen
  // Dancers are started when the houses have met, and poses come through when all is up.
  ASSERT_TRUE(wait_for([&] { return count_in_log(log, "POSE/guest/") > 0; })) << "nobody dances";
  struct Victim {
    const char *program, *mark, *gone;
  };
  for (const Victim& victim : {Victim{"/dance-join", "/house-b.toml", "POSE/guest/"},
                               {"/dance-server", "--port", "POSE/guest/"},
                               {"/dance-record", "/demo.lcm", "POSE/"},
                               {"/dance-salsa", " alice ", "POSE/capture/alice"}}) {
    const char *program = victim.program, *mark = victim.mark, *gone = victim.gone;
    pid_t killed = 0, back = 0;
    ASSERT_TRUE(wait_for([&] { return (killed = demo.pid_of(program, mark)) > 0; })) << program;
    ASSERT_EQ(kill(killed, SIGKILL), 0) << program;
    const auto is_back = [&] { return (back = demo.pid_of(program, mark)) > 0 && back != killed; };
    ASSERT_TRUE(wait_for(is_back)) << program << " is not started again";
    const int before = count_in_log(log, gone);
    ASSERT_TRUE(wait_for([&] { return count_in_log(log, gone) > before + 100; }))
        << gone << " does not go on when " << program << " is back";
  }
  const nlohmann::json& summary = demo.end();
  ASSERT_TRUE(summary.is_object());
  EXPECT_GE(summary["restarts"].get<int>(), 4);
  EXPECT_EQ(summary["guests"].size(), 2u);
  for (const auto& guest : summary["guests"]) EXPECT_GT(guest["delivered"].get<int>(), 0) << guest;
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
